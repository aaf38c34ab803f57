#include "palpate/run/run.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/mesh/read.h"
#include "palpate/mesh/write.h"
#include "palpate/run/notes.h"
#include "palpate/run/plot.h"
#include "palpate/run/tip.h"
#include "tests/refusal.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

namespace palpate {
namespace {

// A soft block on a table, pressed in the middle from above.
const std::string pressed = R"(
[simulation]
duration = 1.2
[camera]
eye = [0.15, 0.12, 0.2]
look_at = "block"
[[body]]
name = "block"
dims = [11, 6, 11]
spacing = 0.01
youngs_modulus = 8000
density = 1000
damping = 10
pin = { below = 0 }
[[tool]]
name = "finger"
radius = 0.012
stiffness = 600
from = [0.05, 0.3, 0.05]
along = [0, -1, 0]
path = [[0.4, 0, 0.002, 0], [0.8, 0, -0.01, 0], [1.1, 0, -0.01, 0]]
)";

Scene scene(const std::vector<Change>& changes = {}) {
    return parse_scene(pressed, "block.toml", ".", changes);
}

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
        EXPECT_EQ(run(scene(), steps).bodies[0].steps, count);
    }
    frames.frames = 0;
    EXPECT_EQ(run(scene(), frames).bodies[0].steps, 0);
}

bool has_note(const Report& report, const std::string& words) {
    return std::ranges::any_of(report.notes,
                               [&](const std::string& note) { return note.find(words) != note.npos; });
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

// Longer frames than a film's: it goes on as fast as the scene.
TEST(Run, LongStepsStillMakeEvenSequences) {
    Scratch scratch;
    RunSettings settings;
    settings.steps = 7;
    settings.sequence = scratch / "s.ply";
    settings.sequence_every = 0.049;  // three frames of 1/60 s
    const Report report =
        run(scene({"simulation.step=0.012", "body.block.youngs_modulus=200", "tool.finger.stiffness=5"}),
            settings);
    EXPECT_EQ(report.frames, 7);
    EXPECT_EQ(scratch.entries(), 2u);  // at 0 and at 0.06 s
}

std::string refusal(const Scene& scene, const RunSettings& settings) {
    return palpate::refusal([&] { run(scene, settings); });
}

TEST(Run, OutputsAreRefusedBeforeTheWork) {
    Scratch scratch;
    auto expect_refused = [&](const RunSettings& settings, const std::string& words) {
        Scene missing = scene();  // which would fail later
        missing.bodies[0].dims.reset();
        missing.bodies[0].surface = "no-such.ply";
        const std::string said = refusal(missing, settings);
        EXPECT_NE(said.find(words), std::string::npos) << said;
    };
    auto with = [&](std::filesystem::path RunSettings::*output, const char* name) {
        RunSettings settings;
        settings.*output = scratch / name;
        return settings;
    };
    expect_refused(with(&RunSettings::plot, "x.png"), "name it " + (scratch / "x.svg").string());
    expect_refused(with(&RunSettings::video, "x.gif"), "name it " + (scratch / "x.mp4").string());
    expect_refused(with(&RunSettings::nodes, "x.png"), "name it " + (scratch / "x.csv").string());
    expect_refused(with(&RunSettings::report, "x.csv"), "name it " + (scratch / "x.json").string());
    expect_refused(with(&RunSettings::sequence, "x.mp4"), ".pc2");
    expect_refused(with(&RunSettings::surface, "x.png"), ".ply");
    for (auto output : {&RunSettings::plot, &RunSettings::nodes, &RunSettings::report, &RunSettings::surface,
                        &RunSettings::sequence, &RunSettings::video, &RunSettings::images})
        expect_refused(with(output, output == &RunSettings::plot      ? "no/x.svg"
                                    : output == &RunSettings::nodes   ? "no/x.csv"
                                    : output == &RunSettings::report  ? "no/x.json"
                                    : output == &RunSettings::video   ? "no/x.mp4"
                                    : output == &RunSettings::surface ? "no/x.ply"
                                                                      : "no/x.glb"),
                       "make it first");
    EXPECT_EQ(scratch.entries(), 0u);
    RunSettings both;
    both.surface = both.sequence = scratch / "x.glb";
    expect_refused(both, "writes a file of this name too");
    RunSettings numbers;
    numbers.image_every = std::nan("");
    expect_refused(numbers, "no time between pictures");
    numbers = {};
    numbers.steps = -1;
    expect_refused(numbers, "negative");
    Scene toolless = scene();
    toolless.tools.clear();
    RunSettings plot;
    plot.plot = scratch / "x.svg";
    EXPECT_NE(refusal(toolless, plot).find("no tool whose force"), std::string::npos);
    Scene still = scene();
    still.bodies.clear();
    RunSettings nodes;
    nodes.nodes = scratch / "x.csv";
    EXPECT_NE(refusal(still, nodes).find("no body that moves"), std::string::npos);
}

TEST(Run, WhatAnEarlierRunLeftIsSaidAndKept) {
    Scratch scratch;
    write_text(scratch / "s-0009.ply", "");
    write_text(scratch / "s-0002.ply", "");  // which is written anew
    write_text(scratch / "s-2.ply", "");     // somebody's own, as the next one
    write_text(scratch / "s-last.ply", "");
    RunSettings settings;
    settings.frames = 6;
    settings.sequence = scratch / "s.ply";
    const Report report = run(scene(), settings);
    EXPECT_TRUE(has_note(report, "1 older file of an earlier run stays in")) << report.notes.size();
    EXPECT_TRUE(has_note(report, "s-0009.ply"));
    EXPECT_EQ(read_text(scratch / "s-0009.ply"), "");
    EXPECT_NE(read_text(scratch / "s-0002.ply"), "");
}

TEST(Run, FramesPerSecondIsNothingWhereNothingMoves) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.02f), 6), scratch / "ball.ply");
    RunSettings settings;
    settings.frames = 2;
    settings.report = scratch / "r.json";
    EXPECT_FALSE(run(parse_scene("[[surface]]\nsurface = \"ball.ply\"\n", "s.toml", scratch / "."), settings)
                     .frames_per_second());
    EXPECT_NE(read_text(settings.report).find("\"frames_per_second\": null"), std::string::npos);
    EXPECT_GT(run(scene(), settings).frames_per_second().value(), 0);
    const std::string pinned =
        "[[body]]\nname = \"b\"\nsurface = \"ball.ply\"\nnodes = 50\nyoungs_modulus = 5000\n"
        "density = 1000\npin = { below = 1 }\n";
    EXPECT_FALSE(run(parse_scene(pinned, "p.toml", scratch / "."), settings).frames_per_second());
    const std::string moved =
        pinned + "[[move]]\nnodes = { below = 1 }\npath = [[0, 0, 0, 0], [1, 1, 0, 0]]\n";
    EXPECT_GT(run(parse_scene(moved, "m.toml", scratch / "."), settings).frames_per_second().value_or(0), 0);
    settings.frames = 0;
    EXPECT_FALSE(run(scene(), settings).frames_per_second());
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

TEST(Notes, AToolThatTouchesNothing) {
    const std::string tool = "pin = { below = 0 }\n[[tool]]\nname = \"tip\"\nradius = 0.02\n";
    EXPECT_TRUE(has_note(run_for(weak + tool + "path = [[0, 0, 1, 0], [0.1, 0, 1, 0]]\n", 8),
                         "tip: it touched nothing all along its path"));
    EXPECT_FALSE(
        has_note(run_for(weak + tool + "path = [[0, 0, 1, 0], [9, 0, 1, 0]]\n", 8), "touched nothing"));
    EXPECT_FALSE(has_note(run_for(weak + tool + "path = [[0, 0, 0.09, 0], [0.1, 0, 0.09, 0]]\n", 8),
                          "touched nothing"));
}

// Case 15: a ball or a rod between the nodes, a plate that is thinner than a step.
TEST(Notes, ObstaclesThatNodesPass) {
    const std::string collider = "[[collider]]\n";
    const Report ball =
        run_for(weak + collider + "sphere = { centre = [0.03, -0.01, 0.03], radius = 0.01 }\n", 1);
    EXPECT_TRUE(
        has_note(ball, "collider 1: it is 0.02 m across, and the nodes of body cube are 0.02 m apart"));
    EXPECT_TRUE(has_note(
        run_for(weak + collider + "capsule = { from = [0, 0, 0], to = [1, 0, 0], radius = 0.01 }\n", 1),
        "0.02 m across"));
    EXPECT_TRUE(
        has_note(run_for(weak + collider + "box = { half = [1, 0.01, 0.01] }\n", 1), "0.02 m across"));
    for (const char* wide :
         {"sphere = { radius = 0.1 }\n", "plane = {}\n", "box = { half = [1, 0.001, 1] }\n"})
        EXPECT_FALSE(has_note(run_for(weak + collider + wide, 1), "across")) << wide;

    // 0.2 mm and 20 mm of steel under a cube that comes with 3 m/s, and a plate of 1 mm that comes with 20
    // m/s.
    const std::string fall = weak + "[simulation]\ngravity = [0, -100, 0]\n" + collider;
    const Report thin = run_for(fall + "box = { centre = [0, -0.4, 0], size = [2, 0.0002, 2] }\n", 6);
    EXPECT_TRUE(has_note(thin, "collider 1: it is 0.0002 m thick, and nodes of body cube go up to"));
    EXPECT_FALSE(
        has_note(run_for(fall + "box = { centre = [0, -0.4, 0], size = [2, 0.02, 2] }\n", 6), "thick"));
    const std::string swung =
        weak + collider +
        "box = { centre = [0, -0.5, 0], size = [2, 0.001, 2] }\npath = [[0, 0, 0, 0], [0.1, 0, 2, 0]]\n";
    EXPECT_TRUE(has_note(run_for(swung, 2), "0.001 m thick"));
}

TEST(Notes, BodiesThatAreGone) {
    // Through a ball that is finer than the lattice, and 10 times its own size down.
    const std::string ball =
        "[simulation]\ngravity = [0, -100, 0]\n[[collider]]\nsphere = { centre = [0.03, -0.01, 0.03], "
        "radius = 0.005 }\n";
    EXPECT_TRUE(has_note(run_for(weak + ball, 20), "cube: it ended"));
    EXPECT_FALSE(has_note(run_for(weak + ball, 2), "it ended"));
}

TEST(Run, WritesWhatIsAskedFor) {
    Scratch scratch;
    RunSettings settings;
    settings.frames = 70;
    settings.width = 161;  // odd, which a film must survive
    settings.height = 91;
    settings.images = scratch / "stills";
    settings.image_every = 0.5;
    settings.report = settings.images / "report.json";  // in a folder that is made
    settings.plot = scratch / "plot.svg";
    settings.nodes = scratch / "nodes.csv";
    settings.surface = scratch / "surface.ply";
    settings.lattice = true;
    const bool film = has_program("ffmpeg");
    if (film) settings.video = scratch / "film.mp4";
    Report report;
    try {
        report = run(scene(), settings);
    } catch (const Error& error) {
        if (std::string(error.what()).find("OpenGL") == std::string::npos) throw;
        GTEST_SKIP() << "not available: " << error.what();
    }
    const auto files = std::filesystem::directory_iterator(settings.images);
    EXPECT_EQ(std::distance(files, {}), 3 + 1);
    if (film) EXPECT_GT(std::filesystem::file_size(settings.video), 1000u);
    const std::string json = read_text(settings.report);
    for (const char* key : {"backend",
                            "integrator",
                            "threads",
                            "nodes",
                            "springs",
                            "vertices",
                            "faces",
                            "steps",
                            "step_s",
                            "simulate",
                            "map",
                            "render",
                            "frames_per_second",
                            "kinetic_energy_j",
                            "elastic_energy_j",
                            "largest_speed_m_s",
                            "deepest_indentation_m",
                            "largest_force_n",
                            "diverged",
                            "at_rest",
                            "rest_s"})
        EXPECT_NE(json.find('"' + std::string(key) + '"'), std::string::npos) << key;
    EXPECT_NE(read_text(settings.plot).find("polyline"), std::string::npos);
    EXPECT_EQ(read_mesh(settings.surface, Units::metres).positions.size(), report.bodies[0].vertices);

    // The CSV reads back to numbers, one line a node.
    std::istringstream lines(read_text(settings.nodes));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "body,id,x,y,z,vx,vy,vz");
    int count = 0;
    while (std::getline(lines, line)) ++count;
    EXPECT_EQ(count, 11 * 6 * 11);
}

// Every kind of collider, one that turns, and a thread that has no surface.
TEST(Run, DrawsWhatThereIs) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.02f), 16), scratch / "ball.ply");
    const std::string text = pressed + R"(
[[body]]
name = "rope"
cloth = [1, 5]
spacing = 0.01
mass = 0.01
move = [0, 0.1, 0]
pin = { nodes = [4] }
[[tool]]
kind = "drag"
body = "rope"
path = [[0, 0.05, 0.1, 0], [1, 0.05, 0.1, 0]]
stiffness = 1
[[collider]]
plane = { offset = -0.05 }
path = [[0, 0, 0, 0, 0, 0, 0], [1, 0, 0.01, 0, 0, 0, 10]]
[[collider]]
sphere = { centre = [0.2, 0, 0], radius = 0.02 }
[[collider]]
capsule = { from = [0.2, 0, 0.05], to = [0.2, 0, 0.1], radius = 0.02 }
[[collider]]
box = { centre = [0.2, 0, 0.2], half = [0.02, 0.02, 0.02], rounding = 0.005 }
path = [[0, 0, 0, 0, 0, 0, 0], [1, 0, 0.1, 0, 0, 90, 0]]
[[collider]]
polygon = { triangles = [[[0.2, 0, 0.3], [0.2, 0, 0.35], [0.2, 0.05, 0.3]]] }
[[collider]]
field = { surface = "ball.ply", move = [-0.1, 0, 0] }
)";
    RunSettings settings;
    settings.frames = 6;
    settings.width = 160;
    settings.height = 90;
    settings.images = scratch / "stills";
    settings.image_every = 0.05;
    settings.lattice = true;
    try {
        const Report report = run(parse_scene(text, "all.toml", scratch / "."), settings);
        EXPECT_FALSE(report.diverged);
        EXPECT_EQ(report.pictures, 3);
    } catch (const Error& error) {
        if (std::string(error.what()).find("OpenGL") == std::string::npos) throw;
        GTEST_SKIP() << "not available: " << error.what();
    }
    EXPECT_NE(read_text(scratch / "stills" / "all-00.00s.png"),
              read_text(scratch / "stills" / "all-00.10s.png"));
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

// The last picture of a sequence is the surface that is written at the end, float for float.
TEST(Run, ASequenceEndsWithTheSurface) {
    Scratch scratch;
    RunSettings settings;
    settings.frames = 60;
    settings.surface = scratch / "end.ply";
    for (const char* name : {"a.ply", "a.pc2"}) {
        settings.sequence = scratch / name;
        run(scene(), settings);
    }
    EXPECT_EQ(read_text(scratch / "a-0031.ply"), read_text(settings.surface));
    EXPECT_NE(read_text(scratch / "a-0001.ply"), read_text(settings.surface));
    EXPECT_EQ(scratch.entries(), 1u + 31 + 2);
    const Mesh end = read_mesh(settings.surface, Units::metres);
    const std::string cache = read_text(scratch / "a.pc2");
    const std::size_t bytes = 12 * end.positions.size();
    ASSERT_EQ(cache.size(), 32 + 31 * bytes);
    EXPECT_EQ(std::memcmp(cache.data() + 32 + 30 * bytes, end.positions.data(), bytes), 0);
}

TEST(Run, EachBodyHasItsOwnSequence) {
    Scratch scratch;
    const std::string another = pressed + R"(
[[body]]
name = "other"
dims = [3, 3, 3]
spacing = 0.01
youngs_modulus = 8000
density = 1000
move = [0.2, 0, 0]
)";
    RunSettings settings;
    settings.frames = 7;
    settings.sequence_every = 0.049;  // three frames of 1/60 s
    settings.sequence = scratch / "s.vtp";
    run(parse_scene(another, "two.toml", "."), settings);
    EXPECT_EQ(scratch.entries(), 2u * (3 + 1));
    EXPECT_NE(read_text(scratch / "s-other.pvd").find("timestep=\"0.1\" file=\"s-other-0003.vtp\""),
              std::string::npos);
    settings.sequence = scratch / "s.glb";
    settings.frames = 1'000'000'000;  // nothing is simulated before it is said that this does not fit
    EXPECT_THROW(run(parse_scene(another, "two.toml", "."), settings), Error);
}

// What was good until a run diverges is whole.
TEST(Run, ASequenceThatDivergesIsKept) {
    Scratch scratch;
    Scene wild = scene({"simulation.step=0.0166", "body.block.damping=0"});
    wild.simulation.force = true;
    RunSettings settings;
    settings.sequence = scratch / "a.pc2";
    settings.sequence_every = 0;  // every frame
    const Report report = run(wild, settings);
    ASSERT_TRUE(report.diverged);
    const std::string cache = read_text(settings.sequence);
    std::int32_t pictures = 0;
    std::memcpy(&pictures, cache.data() + 28, 4);
    EXPECT_EQ(pictures, report.frames + 1);
    EXPECT_EQ(cache.size(), 32 + 12 * report.bodies[0].vertices * std::size_t(pictures));
    for (std::size_t place = 32; place < cache.size(); place += 4) {
        float number;
        std::memcpy(&number, cache.data() + place, 4);
        ASSERT_LE(std::abs(number), 1e3f);
    }
}

TEST(Run, AToolThatMeetsNothingIsNamed) {
    const std::string said = refusal(scene({"tool.finger.from=[1, 1, 1]"}), {});
    EXPECT_NE(said.find("tool.finger.from"), std::string::npos) << said;
    EXPECT_NE(said.find("--set"), std::string::npos) << said;
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

TEST(Run, AFolderThatCannotBeMadeIsSaidBeforeTheWork) {
    RunSettings settings;
    settings.report = "/proc/no/such/report.json";
    EXPECT_THROW(run(scene(), settings), Error);
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

TEST(Plot, SurvivesOddCurves) {
    Scratch scratch;
    write_plot("a < b & c",
               {{"x", "y", {{"none", {}, {}}, {"flat", {0, 1}, {0, 0}}, {"hole", {0, 1}, {1, NAN}}}}},
               scratch / "p.svg");
    const std::string svg = read_text(scratch / "p.svg");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
}

TEST(Plot, PowersLieOnALineWhereAxesAreLogarithmic) {
    Scratch scratch;
    Panel panel{"x", "y", {{"square", {1, 10, 0, 100, 1000}, {1, 100, 5, 1e4, 1e6}}}, true};
    write_plot("", {panel}, scratch / "p.svg");
    const std::string svg = read_text(scratch / "p.svg");
    const std::string before = "<polyline points=\"";
    std::istringstream points(svg.substr(svg.find(before) + before.size()));
    double x[4], y[4];
    char comma;
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(points >> x[i] >> comma >> y[i]) << svg;  // the 0 is left out
    for (int i = 1; i < 4; ++i) {
        EXPECT_NEAR(x[i] - x[i - 1], (x[3] - x[0]) / 3, 0.11);
        EXPECT_NEAR(y[i] - y[i - 1], (y[3] - y[0]) / 3, 0.11);
    }
    EXPECT_GT(x[3] - x[0], 300);
    EXPECT_LT(y[3] - y[0], -200);
}

// The slab that one scene writes is what the other folds: its two ends have gone down by what 30° take.
TEST(Run, TheFiguresOfTheDocsRun) {
    Scratch scratch;
    const std::string folder = PALPATE_SOURCE_DIR "/examples/figures/";
    RunSettings settings;
    settings.frames = 0;
    settings.surface = scratch / "slab.ply";
    run(read_scene(folder + "slab.toml"), settings);
    settings.frames = 40;
    settings.surface = scratch / "folded.ply";
    const std::string fold = read_text(folder + "fold.toml");
    EXPECT_FALSE(run(parse_scene(fold, "fold", scratch / ""), settings).diverged);
    const Bounds box = bounds(read_mesh(settings.surface, Units::metres));
    EXPECT_LE(std::abs(box.size().x - (0.2 * std::cos(0.5236) + 0.06 * std::sin(0.5236))), 0.004);
}

}  // namespace
}  // namespace palpate
