// What a run does and reports, and what its user should know.
#include "palpate/run/run.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/write.h"
#include "palpate/run/notes.h"
#include "palpate/run/tip.h"
#include "tests/refusal.h"
#include "tests/run/pressed.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

namespace palpate {
namespace {

TEST(Run, PressesAndReports) {
    const Report report = run(scene(), {});
    EXPECT_FALSE(report.diverged);
    EXPECT_EQ(report.frames, 72);
    ASSERT_EQ(report.tools.size(), 1u);
    const Report::Tool& finger = report.tools[0];
    EXPECT_GT(finger.deepest_indentation, 0.005);
    EXPECT_LT(finger.deepest_indentation, 0.0101);
    // Between a flat stamp and a ball (Hertz) of this size and depth: the order of magnitude is physics, not
    // chance.
    EXPECT_GT(finger.largest_force, 0.3);
    EXPECT_LT(finger.largest_force, 3);
    for (std::size_t i = 0; i < finger.time.size(); ++i)
        if (finger.time[i] < 0.4 || finger.time[i] > 1.15) EXPECT_EQ(finger.force[i], 0) << finger.time[i];
    EXPECT_EQ(report.bodies[0].nodes, 11u * 6u * 11u);
    EXPECT_GT(report.bodies[0].elastic_energy, 0);
}

TEST(Run, TheSameRunTwiceGivesTheSameBits) {
    Scratch scratch;
    RunSettings a, b;
    a.frames = b.frames = 40;
    a.nodes = scratch / "a.csv";
    b.nodes = scratch / "b.csv";
    run(scene(), a);
    run(scene(), b);
    EXPECT_EQ(read_text(a.nodes), read_text(b.nodes));
}

TEST(Run, StepsAndFramesAreCounted) {
    RunSettings frames, steps;
    frames.frames = 7;
    EXPECT_EQ(run(scene(), frames).frames, 7);
    steps.steps = 10;
    EXPECT_EQ(run(scene({"simulation.step=0.001"}), steps).bodies[0].steps, 10);
    for (long count : {100, 301}) {
        steps.steps = count;
        EXPECT_EQ(run(scene({"tool.1.stiffness=1e-9"}), steps).bodies[0].steps, count);
    }
    steps.steps = 700;
    EXPECT_GT(run(scene(), steps).bodies[0].steps, 700);  // a tool makes them shorter
    frames.frames = 0;
    EXPECT_EQ(run(scene(), frames).bodies[0].steps, 0);
}

// A number of steps is of exactly the step that was asked for; frames are whole ones of 1/60 s, and that is
// said.
TEST(Run, StepsAreAsLongAsAskedForOrItIsSaid) {
    RunSettings settings;
    settings.steps = 25;
    for (const char* step : {"0.0015", "0.001", "0.0008"}) {
        const Scene some = scene({std::string("simulation.step=") + step, "body.block.youngs_modulus=2000"});
        const Report report = run(some, settings);
        EXPECT_EQ(report.bodies[0].steps, 25) << step;
        EXPECT_LE(std::abs(report.bodies[0].step / some.simulation.step - 1), 1e-15) << step;
        EXPECT_LE(std::abs(report.simulated - 25 * some.simulation.step), 1e-12) << step;
        EXPECT_FALSE(has_note(report, "steps were")) << step;
    }
    settings.steps.reset();
    settings.frames = 2;
    auto steps_of = [&](const char* step) {
        return run(scene({std::string("simulation.step=") + step, "body.block.youngs_modulus=2000"}),
                   settings);
    };
    EXPECT_TRUE(has_note(steps_of("0.0015"), "steps were 0.00138889 s and not 0.0015 s"));
    EXPECT_FALSE(has_note(steps_of("0.0016666666666666668"), "steps were"));
    EXPECT_FALSE(has_note(steps_of("\"auto\""), "steps were"));
}

TEST(Run, TheReportSaysWhetherItCameToRest) {
    Scratch scratch;
    RunSettings settings;
    settings.report = scratch / "report.json";
    settings.frames = 2;
    run(scene(), settings);
    EXPECT_NE(read_text(settings.report).find("\"at_rest\": false,\n  \"rest_s\": null"), std::string::npos);
    settings.frames.reset();
    settings.until_rest = Rest::speed;
    const Report report = run(scene({"simulation.duration=1"}), settings);
    ASSERT_TRUE(report.rest.has_value());
    EXPECT_GE(*report.rest, 1.6 - 1e-6);  // half a second after the finger has gone
    EXPECT_NE(read_text(settings.report).find("\"at_rest\": true,\n  \"rest_s\": "), std::string::npos);
}

TEST(Run, DivergenceIsReportedAndNotDrawn) {
    Scene wild = scene({"simulation.step=0.0166", "body.block.damping=0"});
    EXPECT_THROW(run(wild, {}), Error);  // refused without force
    wild.simulation.force = true;
    const Report report = run(wild, {});
    EXPECT_TRUE(report.diverged);
    EXPECT_LT(report.simulated, 1.2);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes.back().find("diverged"), std::string::npos);
    EXPECT_LT(report.bodies[0].largest_speed, 100);
}

TEST(Run, AToolThatMeetsNothingIsNamed) {
    for (const char* word : {"tool.finger.from", "--set"})
        expect_refused(word, [] { run(scene({"tool.finger.from=[1, 1, 1]"}), {}); });
}

// The main job, until the finger holds still 10 mm in.
TEST(Run, TheBrainIsPressed) {
    if (!std::filesystem::exists("/usr/share/mricron/templates/ch2bet.nii.gz"))
        GTEST_SKIP() << "mricron-data is not available";
    RunSettings settings;
    settings.frames = 205;
    const Report report = run(read_scene("brain"), settings);
    EXPECT_FALSE(report.diverged);
    EXPECT_TRUE(report.notes.empty()) << report.notes[0];
    EXPECT_EQ(report.bodies[0].inverted_cells, 0u);
    EXPECT_LE(std::abs(double(report.bodies[0].nodes) / 20'000 - 1), 0.05);
    EXPECT_LE(std::abs(double(report.bodies[0].vertices) / 70'000 - 1), 0.05);
    EXPECT_GT(report.tools[0].deepest_indentation, 0.005);
    EXPECT_LT(report.tools[0].deepest_indentation, 0.0101);
    EXPECT_GT(report.tools[0].largest_force, 0.2);
    EXPECT_LT(report.tools[0].largest_force, 2);
    EXPECT_EQ(report.tools[0].force[110], 0);  // before the tip is there
}

TEST(Tip, StopsWhereItTouches) {
    const Mesh ball = ellipsoid(vec3(0.05f), 80);
    const std::vector<Skin> skins{{ball.positions, ball.normals, &ball.triangles}};
    const auto way = way_to_touch({0, 0, 1}, {0, 0, -1}, 0.01f, skins);
    ASSERT_TRUE(way);
    EXPECT_NEAR(*way, 1 - 0.06f, 2e-5f);
    const auto aside =
        way_to_touch({0.03f, 0, 1}, {0, 0, -1}, 0.01f, skins);  // two balls of 0.05 and 0.01 touch
    EXPECT_NEAR(*aside, 1 - std::sqrt(0.06f * 0.06f - 0.03f * 0.03f), 1e-4f);
    EXPECT_FALSE(way_to_touch({0.07f, 0, 1}, {0, 0, -1}, 0.01f, skins));
    EXPECT_FALSE(way_to_touch({0, 0, -1}, {0, 0, -1}, 0.01f, skins));     // the ball lies behind
    EXPECT_FALSE(way_to_touch({0, 0, 0.05f}, {0, 0, -1}, 0.01f, skins));  // it starts in it
    const Mesh wide = block(vec3(-1), vec3(1, 1, 0), 1);                  // between vertices far apart
    EXPECT_NEAR(
        *way_to_touch({0.1f, 0.2f, 1}, {0, 0, -1}, 0.01f, {{wide.positions, wide.normals, &wide.triangles}}),
        0.99f, 2e-5f);
}

// ---- what its user should know ----

const std::string weak = R"(
[[body]]
name = "cube"
dims = [4, 4, 4]
spacing = 0.02
density = 1000
youngs_modulus = 3e5
damping = 1
link_damping = 0.002
move = [0, 0.02, 0]
)";

Report run_for(const std::string& text, int frames) {
    RunSettings settings;
    settings.frames = frames;
    return run(parse_scene(text, "test.toml", "."), settings);
}

TEST(Notes, AdviceNamesWhatActs) {
    auto advice = [](const std::string& more) {
        const Scene some = parse_scene(weak + more, "test.toml", ".");
        Report report;
        for (std::size_t t = 0; t < some.tools.size(); ++t) report.tools.emplace_back().largest_force = 1;
        return how_to_ask_less(some, report);
    };
    const std::string path = "path = [[0, 0, 0, 0], [1, 0, 0.1, 0]]\n";
    EXPECT_EQ(advice(""), "use a stiffer material: its own weight is too much for it");
    EXPECT_EQ(advice("[[tool]]\n" + path), "press less hard");
    EXPECT_EQ(advice("[[tool]]\nkind = \"drag\"\n" + path), "pull less hard");
    EXPECT_EQ(advice("[[move]]\nnodes = { below = 0 }\n" + path), "move its nodes less far");
    EXPECT_EQ(advice("[[collider]]\nplane = {}\n" + path + "[[tool]]\n" + path),
              "press less hard or push it less far");
    EXPECT_EQ(advice("[simulation]\ngravity = [0, 0, -981]\n"),
              "use less gravity: it is 100 times the Earth's");
    EXPECT_EQ(advice("[simulation]\ngravity = [0, 0, 0]\n"), "press or pull it less hard");
    EXPECT_EQ(advice("[wind]\nvelocity = [9, 0, 0]\n"), "use a stiffer material, or less wind");
}

TEST(Notes, ABodyThatAColliderHoldsAtTheStart) {
    const std::string body = weak + "pin = { below = 0 }\n[[collider]]\n";  // y from 0.02 to 0.08
    for (const auto& [shape, words] : std::vector<std::array<std::string, 2>>{
             {"plane = { offset = 10 }", "1 holds 48 of 64"},
             {"plane = { offset = 0.05 }", "1 holds 16 of 64"},
             {"margin = 5\nplane = {}", "1 holds 48 of 64"},
             {"sphere = { centre = [0.03, 0.05, 0.03], radius = 1 }", "1 holds 48 of 64"},
             {"sphere = { centre = [0.03, 0.05, 0.03], radius = 0.02 }", "1 holds 8 of 64"},
             {"capsule = { from = [0, 0.08, 0], to = [0.06, 0.08, 0], radius = 0.005 }", "1 holds 4 of 64"},
             {"box = { centre = [0.03, 0.05, 0.03], size = [1, 1, 1] }", "1 holds 48 of 64"},
             {"plane = {}\npath = [[0, 0, 0.05, 0], [1, 0, 0, 0]]", "1 holds 16 of 64"}}) {
        const Report report = run_for(body + shape + "\n", 0);
        EXPECT_TRUE(has_note(report, "collider " + words + " nodes of body cube at the start")) << shape;
        const Scene some = parse_scene(body + shape + "\n", "test.toml", ".");
        EXPECT_NE(how_to_ask_less(some, report).find("move the colliders away from body cube"),
                  std::string::npos);
    }
    for (const char* shape :
         {"plane = {}", "plane = { offset = 0.02 }", "plane = { offset = 0.02 }\nmargin = 0.001",
          "sphere = { centre = [0.03, 0.2, 0.03], radius = 0.1 }",
          "plane = {}\npath = [[0, 0, -0.1, 0], [1, 0, 0, 0]]",
          "polygon = { triangles = [[[-1, 0.05, -1], [1, 0.05, -1], [0, 0.05, 2]]] }"})
        EXPECT_FALSE(has_note(run_for(body + std::string(shape) + "\n", 0), "at the start")) << shape;
}

// A soft block that its own weight turns inside out, with a tool that is far away.
TEST(Notes, NobodyIsToldToPressLessWhereNothingPresses) {
    const Report report = run_for(R"(
[[body]]
name = "jelly"
dims = [5, 9, 5]
spacing = 0.02
density = 1000
youngs_modulus = 300
damping = 5
pin = { below = 0 }
[[tool]]
path = [[0, 9, 9, 9], [100, 9, 9, 9]]
)",
                                  40);
    EXPECT_TRUE(has_note(report, "were inside out; use a stiffer material"));
    EXPECT_FALSE(has_note(report, "press less"));
}

TEST(Notes, WhatNothingHolds) {
    EXPECT_TRUE(has_note(run_for(weak, 1), "cube: nothing holds it, so it falls"));
    for (const char* more :
         {"pin = { nodes = [0] }\n", "[simulation]\ngravity = [0, 0, 0]\n", "[[collider]]\nplane = {}\n"})
        EXPECT_FALSE(has_note(run_for(weak + more, 1), "nothing holds it")) << more;
}

TEST(Notes, ABodyThatCannotHoldItself) {
    std::string soft = weak + "pin = { below = 0 }\n";
    EXPECT_FALSE(has_note(run_for(soft, 1), "its own weight"));
    soft.replace(soft.find("3e5"), 3, "1e3");
    const Report report = run_for(soft, 1);
    EXPECT_TRUE(
        has_note(report, "cube: its own weight strains it by 49 %"));  // 1000 kg/m³ x 9.81 m/s² x 5 cm
    EXPECT_TRUE(has_note(report, "give it youngs_modulus = 4.9e+03 Pa for 10 %"));
    EXPECT_FALSE(has_note(run_for(soft + "[simulation]\ngravity = [0, 0, 0]\n", 1), "its own weight"));
    soft.replace(soft.find("1e3"), 3, "2.5e3");
    EXPECT_FALSE(has_note(run_for(soft, 1), "its own weight"));
}

TEST(Notes, AToolThatTouchesNothing) {
    const std::string tool = "pin = { below = 0 }\n[[tool]]\nname = \"tip\"\nradius = 0.02\n";
    EXPECT_TRUE(has_note(run_for(weak + tool + "path = [[0, 0, 1, 0], [0.1, 0, 1, 0]]\n", 8),
                         "tip: it touched nothing all along its path"));
    EXPECT_FALSE(
        has_note(run_for(weak + tool + "path = [[0, 0, 1, 0], [9, 0, 1, 0]]\n", 8), "touched nothing"));
    EXPECT_FALSE(has_note(run_for(weak + tool + "path = [[0, 0, 0.09, 0], [0.1, 0, 0.09, 0]]\n", 8),
                          "touched nothing"));
}

// A ball, a rod or the edge of a plate between the nodes.
TEST(Notes, ObstaclesThatNodesPass) {
    const std::string collider = "[[collider]]\n";
    const Report ball =
        run_for(weak + collider + "sphere = { centre = [0.03, -0.01, 0.03], radius = 0.01 }\n", 1);
    EXPECT_TRUE(
        has_note(ball, "collider 1: it is 0.02 m across, and the nodes of body cube are 0.02 m apart"));
    for (const char* fine :
         {"capsule = { from = [0, 0, 0], to = [1, 0, 0], radius = 0.01 }\n",
          "box = { half = [1, 0.01, 0.01] }\n",
          "box = { centre = [0.03, -0.3, 0.03], size = [0.002, 0.6, 1] }\n",
          "box = { centre = [0.03, -0.3, 0.03], size = [1, 0.6, 0.002], rotate = [0, 20, 0] }\n",
          "box = { centre = [0.5, 0.05, 0.03], size = [0.8, 0.5, 0.002] }\npath = [[0, 0, 0, 0], [1, -1, 0, "
          "0]]\n"})
        EXPECT_TRUE(has_note(run_for(weak + collider + fine, 1), " m across, and the nodes")) << fine;
    for (const char* wide :
         {"sphere = { radius = 0.1 }\n", "plane = {}\n", "box = { half = [1, 0.001, 1] }\n",
          "box = { centre = [0.03, -0.3, 0.03], size = [0.021, 0.6, 1] }\n",   // thicker than the nodes are
                                                                               // apart
          "box = { centre = [-0.001, 0.3, 0.03], size = [0.002, 0.6, 1] }\n",  // a wall beside the cube
          "box = { centre = [0.03, 0.6, 0.03], size = [0.002, 0.6, 1] }\n",    // above it
          "box = { centre = [0.03, -0.3, 0.03], size = [1, 0.002, 1] }\npath = [[0, 0, 0, 0], [1, 0, 1, "
          "0]]\n"})
        EXPECT_FALSE(has_note(run_for(weak + collider + wide, 1), "across")) << wide;
}

// What a run leaves of a body's height: that of its lowest and of its highest node.
std::array<double, 2> heights_after(const std::string& text, int frames, const Scratch& scratch) {
    RunSettings settings;
    settings.frames = frames;
    settings.nodes = scratch / "nodes.csv";
    const Report report = run(parse_scene(text, "test.toml", scratch / "."), settings);
    EXPECT_FALSE(has_note(report, "pass through")) << text;
    std::array<double, 2> heights{1e9, -1e9};
    std::istringstream rows(read_text(settings.nodes));
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
        double x = 0, y = 0;
        int id = 0;
        EXPECT_EQ(std::sscanf(row.c_str(), "cube,%d,%lf,%lf", &id, &x, &y), 3) << row;
        heights = {std::min(heights[0], y), std::max(heights[1], y)};
    }
    return heights;
}

// Plates of a few tenths of a millimetre, and a cube that comes with 4 m/s, or a plate that comes with 20
// m/s.
TEST(Obstacles, HoweverThinTheyStopWhatTheyMeet) {
    Scratch scratch;
    std::mt19937 random(15);
    for (int round = 0; round < 4; ++round) {
        const double thick = std::pow(10.0, std::uniform_real_distribution(-4.5, -3.0)(random)),
                     top = -0.05 * round;
        const std::string box = fmt::format(
            "[[collider]]\nbox = {{ centre = [0, {}, 0], size = [2, {}, 2] }}\n", top - thick / 2, thick);
        const std::string fall = weak + "[simulation]\ngravity = [0, -100, 0]\n" + box;
        const auto [low, high] = heights_after(fall, 20, scratch);
        EXPECT_LE(std::abs(low - top), 1e-3) << thick;
        EXPECT_LE(high, top + 0.1) << thick;
        const auto swung = heights_after(weak + box + "path = [[0, 0, 0, 0], [0.1, 0, 2, 0]]\n", 6, scratch);
        EXPECT_GE(swung[0], top + 2 - 1e-3) << thick;
    }
}

// The walls of a field decide how fine its grid is: a cube lies on a table and on a plate of whatever
// thickness.
TEST(Obstacles, FieldsOfThinWallsCarry) {
    Scratch scratch;
    std::mt19937 random(8);
    std::string on_top = weak;
    on_top.replace(on_top.find("move"), std::string::npos, "move = [-0.03, 0.05, -0.03]\n");
    const double any = std::uniform_real_distribution(0.01, 0.06)(random);
    for (const auto& [side, thick] : {std::pair(2.0, 0.03), {0.3, 0.003}, {0.6, 0.6 * any}, {2.0, 0.04}}) {
        write_mesh(block(vec3(-side / 2, -thick, -side / 2), vec3(side / 2, 0, side / 2)),
                   scratch / "plate.obj");
        const auto [low, high] =
            heights_after(on_top + "[[collider]]\nfield = { surface = \"plate.obj\" }\n", 40, scratch);
        EXPECT_LE(std::abs(low), 1e-3) << side << ' ' << thick;
        EXPECT_LE(std::abs(high - 0.06), 1e-3) << side << ' ' << thick;
    }
}

// A field looks only so far ahead.
TEST(Notes, FieldsThatNodesPassInOneStep) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.03f), 16), scratch / "ball.obj");
    auto swung = [&](const std::string& to) {
        RunSettings settings;
        settings.frames = 2;
        return run(
            parse_scene(
                weak + "[[collider]]\nfield = { surface = \"ball.obj\" }\npath = [[0, 0, -1, 0], [1, 0, " +
                    to + ", 0]]\n",
                "test.toml", scratch / "."),
            settings);
    };
    EXPECT_TRUE(has_note(swung("1500"), "and its field looks 0.0225 m ahead"));
    EXPECT_FALSE(has_note(swung("30"), "ahead"));
}

TEST(Notes, BodiesThatAreGone) {
    // Through a ball that is finer than the lattice, and 10 times its own size down.
    const std::string ball =
        "[simulation]\ngravity = [0, -100, 0]\n[[collider]]\nsphere = { centre = [0.03, -0.01, 0.03], "
        "radius = 0.005 }\n";
    EXPECT_TRUE(has_note(run_for(weak + ball, 20), "cube: it ended"));
    EXPECT_FALSE(has_note(run_for(weak + ball, 2), "it ended"));
}

}  // namespace
}  // namespace palpate
