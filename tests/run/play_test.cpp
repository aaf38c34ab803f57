// What acts on bodies while a scene runs, and when it ends.
#include "palpate/run/play.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/write.h"
#include "palpate/run/run.h"
#include "tests/refusal.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace palpate {
namespace {

Scene scene(const std::string& text) { return parse_scene(text, "test.toml", "."); }

struct Ended {
    Report report;
    std::vector<std::vector<dvec3>> positions;  // of each body, at the end

    dvec3 middle(std::size_t body) const {
        dvec3 sum(0);
        for (dvec3 p : positions[body]) sum += p;
        return sum / double(positions[body].size());
    }
};

Ended run_to_end(const Scene& scene, RunSettings settings = {}) {
    Scratch scratch;
    settings.nodes = scratch / "nodes.csv";
    Ended ended{run(scene, settings), {}};
    std::istringstream lines(read_text(settings.nodes));
    std::string line, last;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string name, word;
        std::getline(words, name, ',');
        std::getline(words, word, ',');
        dvec3 p;
        for (int k = 0; k < 3; ++k) {
            std::getline(words, word, ',');
            p[k] = std::stod(word);
        }
        if (name != last) ended.positions.emplace_back();
        last = name;
        ended.positions.back().push_back(p);
    }
    return ended;
}

Mesh still_block() { return block(vec3(-0.1f, -0.05f, -0.1f), vec3(0.1f, 0, 0.1f), 1); }

std::string block(const std::string& name, const std::string& more = "") {
    return "[[body]]\nname = \"" + name +
           "\"\ndims = [3, 3, 3]\nspacing = 0.01\nyoungs_modulus = 5000\ndensity = 1000\n" + more;
}

const std::string weightless = "[simulation]\ngravity = [0, 0, 0]\nduration = 1\n";

// ---- prescribed motion ----

TEST(Play, MovedNodesEndWhereTheirPathSays) {
    // A quarter turn about z through the origin, and a shift.
    const Scene turned = scene(weightless + block("cube", "damping = 5\n") + R"(
[[move]]
nodes = { box = [[-1, -1, -1], [0.001, 1, 1]] }
about = [0, 0, 0]
path = [[0, 0, 0, 0, 0, 0, 0], [0.5, 0.1, 0, 0, 0, 0, 90]]
)");
    const Ended ended = run_to_end(turned);
    EXPECT_FALSE(ended.report.diverged);
    EXPECT_EQ(ended.report.bodies[0].pinned, 9u);
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y) {
            const dvec3 there = ended.positions[0][std::size_t(3 * y + 9 * z)];
            EXPECT_LT(glm::distance(there, dvec3(0.1 - 0.01 * y, 0, 0.01 * z)), 1e-7) << y << z;
            // The rest has followed.
            const dvec3 far = ended.positions[0][std::size_t(2 + 3 * y + 9 * z)];
            EXPECT_LT(glm::distance(far, dvec3(0.1 - 0.01 * y, 0.02, 0.01 * z)), 1e-3) << y << z;
        }
}

TEST(Play, AMoveBeginsAtItsFirstRowAndIsEvenBetween) {
    const Scene late = scene(weightless + block("cube") + R"(
[[move]]
nodes = { nodes = [0, 26] }
path = [[0.5, 0, 0, 0, 0, 0, 0], [1.5, 0, 0, 0, 180, 0, 0]]
)");
    RunSettings settings;
    settings.frames = 20;
    EXPECT_LT(glm::length(run_to_end(late, settings).positions[0][0]), 1e-9);
    settings.frames = 60;  // half of the way: a quarter turn about x through the middle between them
    const Ended half = run_to_end(late, settings);
    EXPECT_LT(glm::distance(half.positions[0][0], dvec3(0, 0.02, 0)), 1e-7);
    EXPECT_LT(glm::distance(half.positions[0][26], dvec3(0.02, 0, 0.02)), 1e-7);
}

// ---- colliders that move ----

TEST(Play, AFrameOfMotionEndsAtThePose) {
    const Pose from = pose({0, {0.1f, 0.2f, 0.3f}, {10, 20, 30}}),
               to = pose({1, {0.2f, 0, 0.1f}, {25, -20, 60}});
    const vec3 pivot(1, 2, 3);
    const double seconds = 1.0 / 60;
    const Motion motion = motion_between(from, to, pivot, seconds), end = after(motion, float(seconds));
    for (vec3 p : {vec3(0), vec3(0.1f, 0, 0), vec3(0, 0.3f, 0.2f)}) {
        EXPECT_LT(glm::distance(motion.position + motion.rotation * p, pivot + vec3(from.of(dvec3(p)))),
                  1e-6f);
        EXPECT_LT(glm::distance(end.position + end.rotation * p, pivot + vec3(to.of(dvec3(p)))), 1e-6f);
    }
    const Motion still = motion_between(to, to, pivot, seconds);
    EXPECT_EQ(still.velocity, vec3(0));
    EXPECT_LT(glm::length(still.spin), 1e-4f);
}

TEST(Play, ACollidersOwnPlaceTurnsAboutTheGivenPoint) {
    const Scene round = scene(block("cube") + R"(
[[collider]]
sphere = { centre = [0.1, 0, 0], radius = 0.01 }
about = [0, 0, 0]
path = [[0, 0, 0, 0, 0, 0, 0], [1, 0, 0, 0.5, 0, 0, 90]]
[[collider]]
plane = { offset = -1 }
)");
    const Models made = build(round);
    Report report;
    const Play play(round, made, report);
    const auto motions = play.colliders(1, 0.01);
    const vec3 centre = std::get<Sphere>(made.simulation.colliders[0].shape).centre;
    EXPECT_LT(glm::distance(motions[0].position + motions[0].rotation * centre, vec3(0, 0.1f, 0.5f)), 1e-6f);
    EXPECT_EQ(motions[1].position, vec3(0));
    EXPECT_EQ(motions[1].rotation, mat3(1));
}

TEST(Play, AMovingPlaneLiftsABody) {
    const std::string text = R"(
[simulation]
duration = 1.5
)" + block("cube", "damping = 10\n") +
                             "[[collider]]\nplane = {}\n";
    const double still = run_to_end(scene(text)).middle(0).y;
    const Ended lifted = run_to_end(scene(text + "path = [[0.2, 0, 0, 0], [0.7, 0, 0.05, 0]]\n"));
    EXPECT_NEAR(lifted.middle(0).y - still, 0.05, 1e-4);
}

TEST(Play, ATurningPlateCarriesABodyRound) {
    const Scene plate =
        scene("[simulation]\nduration = 1.2\n" + block("cube", "damping = 3\nmove = [0.05, 0, 0]\n") + R"(
[[collider]]
box = { centre = [0, -0.01, 0], half = [0.2, 0.01, 0.2] }
friction = 1
path = [[0.2, 0, 0, 0, 0, 0, 0], [1.0, 0, 0, 0, 0, 40, 0]]
)");
    // Turning about y takes x to -z.
    const dvec3 middle = run_to_end(plate).middle(0);
    EXPECT_NEAR(std::atan2(-middle.z, middle.x) * 180 / 3.14159265,
                std::atan2(-0.01, 0.06) * 180 / 3.14159265 + 40, 4);
}

// ---- tools ----

TEST(Play, ADragAtRestPullsWithStiffnessTimesDistance) {
    const std::string text = weightless + "integrator = \"semi-implicit-euler\"\n" +
                             block("cube", "damping = 20\npin = { below = 0 }\n");
    const Ended ended = run_to_end(scene(text + R"(
[[tool]]
kind = "drag"
near = [0.02, 0.02, 0.02]
relative = true
stiffness = 2
path = [[0.1, 0, 0, 0], [0.3, 0, 0.02, 0], [2, 0, 0.02, 0]]
)"));
    const dvec3 held = ended.positions[0][26], target(0.02, 0.04, 0.02);
    EXPECT_GT(held.y, 0.021);
    EXPECT_LT(held.y, 0.039);
    const Report::Tool& tool = ended.report.tools[0];
    EXPECT_NEAR(tool.force.back() / (2 * glm::distance(held, target)), 1, 1e-3);
    EXPECT_GE(tool.largest_force, tool.force.back());
    EXPECT_EQ(tool.force.front(), 0);
    EXPECT_EQ(tool.deepest_indentation, 0);
}

TEST(Play, ADragTakesTheNearestBodyUnlessToldOtherwise) {
    const std::string text =
        weightless + block("near", "damping = 5\n") + block("far", "damping = 5\nmove = [0.1, 0, 0]\n") +
        "[[tool]]\nkind = \"drag\"\npath = [[0, 0, 0.03, 0], [2, 0, 0.03, 0]]\nstiffness = 1\n";
    const Ended nearest = run_to_end(scene(text)), told = run_to_end(scene(text + "body = \"far\"\n"));
    EXPECT_GT(nearest.middle(0).y, 0.012);
    EXPECT_GT(told.middle(1).y, 0.012);
    EXPECT_NEAR(nearest.middle(1).y, 0.01, 1e-6);
    EXPECT_NEAR(told.middle(0).y, 0.01, 1e-6);
    EXPECT_THROW(run_to_end(scene(weightless + block("cube", "pin = { below = 1 }\n") +
                                  "[[tool]]\nkind = \"drag\"\npath = [[0, 0, 0, 0]]\n")),
                 Error);
}

// ---- wind and regions ----

TEST(Play, AHangingClothLeansInTheWind) {
    // Flat, at the angle where the air's pressure balances the weight: half the density of the air
    // x (v cos a)^2 = weight per area x sin a.
    const Scene flag = scene(R"(
[simulation]
duration = 4
[wind]
velocity = [0, 0, 1.5]
[[body]]
cloth = [6, 11]
spacing = 0.02
springs = { structural = 100, shear = 50, flexion = 5 }
density = 0.15
damping = 4
pin = { box = [[-1, 0.199, -1], [1, 0.201, 1]] }
)");
    const Ended ended = run_to_end(flag);
    const double q = 0.5 * 1.2 * 1.5 * 1.5 / (0.15 * 9.81);
    const double leaning = std::asin((std::sqrt(1 + 4 * q * q) - 1) / (2 * q));
    const dvec3 hem = ended.positions[0][2] - ended.positions[0][62];
    EXPECT_NEAR(std::atan2(hem.z, -hem.y), leaning, 0.05);
}

TEST(Play, AStifferRegionDeformsLess) {
    auto hanging = [](const std::string& region) {
        const Ended ended = run_to_end(
            scene("[simulation]\nduration = 1.5\n" +
                  block("cube", "damping = 20\npin = { box = [[-1, 0.019, -1], [1, 1, 1]] }\n") + region));
        return -ended.positions[0][13 - 3].y;  // how far its lowest layer, at 0 when at rest, has come down
    };
    const std::string all = "[[body.region]]\nbox = [[-1, -1, -1], [1, 1, 1]]\n";
    const double soft = hanging(""), hard = hanging(all + "factor = 4\n");
    EXPECT_GT(soft, 1e-4);
    EXPECT_NEAR(soft / hard, 4, 0.1);
    EXPECT_EQ(hanging(all + "youngs_modulus = 20000\n"), hard);
    const double half = hanging("[[body.region]]\nbox = [[-1, -1, -1], [1, 0.011, 1]]\nfactor = 4\n");
    EXPECT_LT(half, 0.95 * soft);
    EXPECT_GT(half, 1.05 * hard);
}

// ---- the end ----

TEST(Play, WhenOneBodyDivergesAllGoBackToTheSameMoment) {
    // The first falls freely; the second is twisted faster than its step can bear.
    Scene two = scene("[simulation]\nstep = 0.002\nduration = 1\n" + block("falling") + block("wild") + R"(
[[move]]
body = "wild"
nodes = { box = [[-1, -1, -1], [0.001, 1, 1]] }
path = [[0.2, 0, 0, 0, 0, 0, 0], [0.3, 50, 0, 0, 0, 0, 0]]
)");
    two.simulation.force = true;
    const Ended ended = run_to_end(two);
    ASSERT_TRUE(ended.report.diverged);
    ASSERT_GT(ended.report.frames, 5);
    const double t = ended.report.simulated;
    EXPECT_NEAR(ended.middle(0).y, 0.01 - 0.5 * 9.81 * t * t, 1e-5);
    EXPECT_EQ(ended.report.bodies[0].steps, ended.report.bodies[1].steps);
}

TEST(Play, ARunEndsAtRest) {
    const std::string text =
        "[simulation]\nduration = 2\n" + block("cube", "damping = 10\npin = { below = 0 }\n");
    RunSettings settings;
    settings.until_rest = Rest::speed;
    const Report damped = run(scene(text), settings);
    ASSERT_TRUE(damped.rest.has_value());
    EXPECT_EQ(*damped.rest, damped.simulated);
    EXPECT_GT(*damped.rest, 0.6);
    EXPECT_LT(*damped.rest, 5);
    EXPECT_LT(damped.bodies[0].kinetic_energy, 1e-9);
    EXPECT_TRUE(damped.notes.empty());

    // What stands still from the start must do so for half a second.
    const Report standing = run(scene(weightless + block("cube")), settings);
    EXPECT_EQ(standing.frames, 30);
    // What a path will yet push is not at rest.
    const std::string path = "[[tool]]\npath = [[0.5, 1, 1, 1], [0.9, 1, 1, 1]]\n";
    EXPECT_GE(run(scene(weightless + block("cube") + path), settings).rest.value(), 1.4 - 1e-6);

    settings.until_rest = Rest::none;
    EXPECT_EQ(run(scene(text), settings).frames, 120);
}

TEST(Play, WhatSwingsForeverIsStoppedWithANote) {
    const Scene swinging = scene("[simulation]\nduration = 0.2\n" + block("cube", "pin = { below = 0 }\n"));
    RunSettings settings;
    settings.until_rest = Rest::speed;
    const Report report = run(swinging, settings);
    EXPECT_FALSE(report.rest);
    EXPECT_EQ(report.frames, 120);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes.back().find("not at rest after 2 s"), std::string::npos) << report.notes.back();
}

TEST(Play, TheRuleOf2012LooksAtOneStep) {
    // A step of 1/60 s under gravity moves what falls by 2.7 mm, then by more: never by less than 1 mm.
    RunSettings settings;
    settings.until_rest = Rest::move;
    Scene falling = scene("[simulation]\nstep = 0.0166666667\nduration = 0.05\n" + block("cube"));
    falling.bodies[0].material.youngs_modulus = 5;
    EXPECT_FALSE(run(falling, settings).rest);
    // Short steps are small moves from the first on.
    falling.simulation.step = 0.001;
    EXPECT_EQ(run(falling, settings).frames, 1);
}

TEST(Play, NothingIsASceneToo) {
    RunSettings settings;
    settings.frames = 3;
    EXPECT_EQ(run(Scene{}, settings).frames, 3);
    settings.until_rest = Rest::speed;
    EXPECT_EQ(run(Scene{}, settings).frames, 3);
    const Report rope = run(scene("[[body]]\nname = \"rope\"\ncloth = [1, 9]\nspacing = 0.01\nmass = 0.01\n"
                                  "pin = { nodes = [0] }\n"),
                            settings);
    EXPECT_FALSE(rope.diverged);
    EXPECT_EQ(rope.bodies[0].faces, 0u);
}

// ---- tools that are felt ----

// A scene with a block that nothing moves, its top at y = 0, and a tip that goes 4 mm into it.
Scene felt_scene(const Scratch& scratch, const std::string& touch, const std::string& device) {
    write_mesh(still_block(), scratch / "block.obj");
    return parse_scene(
        "[simulation]\nduration = 4\n[[surface]]\nname = \"block\"\nsurface = \"block.obj\"\ntouch = " +
            touch + "\n[[tool]]\nkind = \"dent\"\nradius = 0.003\ndevice = \"" + device +
            "\"\nfrom = [0.01, 0.1, 0.01]\npath = [[0.1, 0, 0.01, 0], [1.3, 0, 0.002, 0], [2, 0, -0.004, 0], "
            "[3, 0, -0.004, 0], [3.5, 0, 0.02, 0]]\n",
        "test.toml", scratch / "");
}

TEST(Play, ADentIsFeltAndShown) {
    Scratch scratch;
    const Report report = run(felt_scene(scratch, "{ stiffness = 300 }", "script"), {});
    ASSERT_EQ(report.tools.size(), 1u);
    EXPECT_LE(std::abs(report.tools[0].largest_force - 300 * 0.004), 0.01 * 300 * 0.004);
    EXPECT_LE(std::abs(report.tools[0].deepest_indentation - 0.004), 1e-5);
    ASSERT_EQ(report.bodies.size(), 1u);
    EXPECT_EQ(report.bodies[0].name, "block");
    EXPECT_EQ(report.bodies[0].nodes, 0u);
    EXPECT_GT(report.bodies[0].faces, 0u);
}

TEST(Play, AnArmIsPushedBackWhereAScriptIsNot) {
    Scratch scratch;
    const Report report = run(felt_scene(scratch, "{ stiffness = 300 }", "hand"), {});
    EXPECT_LE(report.tools[0].deepest_indentation, 0.0025);
    EXPECT_GE(report.tools[0].deepest_indentation, 0.0005);
}

TEST(Play, ADeviceThatThereIsNoneOfIsRefused) {
    Scratch scratch;
    const std::string said = refusal([&] { run(felt_scene(scratch, "{ stiffness = 300 }", "spoon"), {}); });
    EXPECT_EQ(
        said,
        "tool tool1: no device \"spoon\" that follows a path in test.toml, line 10; there are hand, script");
}

TEST(Play, WhatIsDeeperThanItYieldsStaysInThePicture) {
    Scratch scratch;
    const Scene scene = felt_scene(scratch, "{ stiffness = 300, yield = 0.001 }", "script");
    const Models made = build(scene);
    Report report;
    Play play(scene, made, report);
    double time = 0;
    auto until = [&](double end) {
        for (; time < end - 1e-9; time += frame_seconds) play.advance(time, frame_seconds);
    };
    until(2.5);
    EXPECT_EQ(play.dents(0).size(), 2u);
    until(3.9);
    const std::vector<Dent> left = play.dents(0);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_LE(std::abs(left[0].depth - 0.003f), 1e-5f);
}

// A cloth that is pinned all around, and a tip that comes from either side.
TEST(Play, AClothIsFeltFromBothSides) {
    for (const char* path : {"[[0, 0.02, 0.02, 0.02], [1.2, 0.02, 0.02, 0.02], [2, 0.02, 0.02, -0.002], [3, "
                             "0.02, 0.02, -0.002]]",
                             "[[0, 0.02, 0.02, -0.02], [1.2, 0.02, 0.02, -0.02], [2, 0.02, 0.02, 0.002], [3, "
                             "0.02, 0.02, 0.002]]"}) {
        const Scene felt =
            scene(std::string("[simulation]\nduration = 3\ngravity = [0, 0, 0]\n"
                              "[[body]]\nname = \"cloth\"\ncloth = [5, 5]\nspacing = 0.01\nmass = 0.01\n"
                              "touch = { stiffness = 200 }\n"
                              "[[tool]]\nkind = \"dent\"\nradius = 0.003\npath = ") +
                  path + "\n");
        const Models made = build(felt);
        Report report;
        Play play(felt, made, report);
        EXPECT_TRUE(play.skins()[0].is_sheet);
        Bounds box;
        for (vec3 p : play.skins()[0].positions) box.include(p);
        const Report done = run(felt, {});
        EXPECT_GT(done.tools[0].largest_force, 0.5)
            << path << box.low.x << box.low.y << box.low.z << " " << box.high.x << box.high.y << box.high.z;
    }
}

// A body that falls past: the tip feels it come, and its patch moves on between frames.
TEST(Play, AMovingBodyIsFeltToo) {
    const Scene falling = scene("[simulation]\nduration = 0.5\ngravity = [0, -0.5, 0]\n" +
                                block("cube", "damping = 1\ntouch = { stiffness = 200 }\n") +
                                "[[tool]]\nkind = \"dent\"\nradius = 0.004\npath = [[0, 0.01, -0.03, 0.01], "
                                "[1, 0.01, -0.03, 0.01]]\n");
    const Report report = run(falling, {});
    EXPECT_GT(report.tools[0].deepest_indentation, 0.01);
    EXPECT_LE(report.tools[0].largest_force, 3.3001);
    for (double depth : report.tools[0].indentation) EXPECT_TRUE(std::isfinite(depth));
}

// A block that a tip of that kind presses by 5 mm, and that comes to rest.
Report press_by(const std::string& tool, const std::string& body = "", const std::string& simulation = "") {
    return run(
        scene("[simulation]\nduration = 2.5\n" + simulation +
              "[[body]]\nname = \"block\"\ndims = [11, 7, 11]\nspacing = 0.006\n"
              "youngs_modulus = 4000\ndensity = 1000\ndamping = 10\npin = { below = 0 }\n" +
              body + "[[tool]]\nradius = 0.012\n" + tool +
              "from = [0.03, 0.3, 0.03]\n"
              "path = [[0, 0, 0.003, 0], [1.2, 0, 0.003, 0], [1.5, 0, -0.005, 0], [3, 0, -0.005, 0]]\n"),
        {});
}

// On a script it feels what a press of the same size and stiffness is pushed back with, at rest and
// on the way; an arm yields to it.
TEST(Play, AHandFeelsTheBodyThatItPresses) {
    const std::string touch = "kind = \"touch\"\n",
                      feel = "touch = { stiffness = 500, friction = 0, damping = 0 }\n";
    const Report pressed = press_by("kind = \"press\"\nstiffness = 500\n");
    const double at_rest = pressed.tools[0].force.back();
    EXPECT_GT(at_rest, 0.05);
    for (const char* backend : {"cpu", "reference"}) {
        const Report felt = press_by(touch, feel, std::string("backend = \"") + backend + "\"\n");
        EXPECT_LE(std::abs(felt.tools[0].force.back() / at_rest - 1), 0.002) << backend;
        EXPECT_LE(std::abs(felt.tools[0].indentation.back() / pressed.tools[0].indentation.back() - 1), 0.01);
        for (std::size_t i = 84; i < felt.tools[0].time.size(); ++i)  // from when its force has ramped up
            EXPECT_LE(std::abs(felt.tools[0].force[i] - pressed.tools[0].force[i]), 0.05 * at_rest) << i;
        EXPECT_EQ(felt.bodies[0].inverted_cells, 0u);
    }
    const Report arm = press_by(touch + "device = \"hand\"\n", feel);
    EXPECT_LE(arm.tools[0].force.back(), 0.999 * at_rest);
    EXPECT_GE(arm.tools[0].force.back(), 0.5 * at_rest);
    const auto& last = arm.tools[0].force;
    EXPECT_LE(std::abs(last[last.size() - 20] / last.back() - 1), 0.01);  // it stands still
}

// It drags what it strokes along with it, and feels that: as much as a press of the same friction, until it
// slips.
TEST(Play, AHandStrokesWithFriction) {
    auto stroked = [](const std::string& tool, const std::string& feel) {
        const Scene stroke = scene(
            "[[body]]\nname = \"block\"\ndims = [17, 7, 11]\nspacing = 0.006\nyoungs_modulus = 4000\n"
            "density = 1000\ndamping = 10\npin = { below = 0 }\n" +
            feel + "[[tool]]\nradius = 0.012\nfrom = [0.03, 0.3, 0.03]\n" + tool +
            "path = [[0, 0, 0.003, 0], [1.2, 0, 0.003, 0], [1.4, 0, -0.003, 0], [2, 0.03, -0.003, 0], "
            "[3, 0.03, -0.003, 0]]\n");
        const Models made = build(stroke);
        Report report;
        Play play(stroke, made, report, nullptr, {}, true);
        std::vector<double> ratios;  // of friction to the normal force, each frame
        for (int frame = 0; frame < 119; ++frame) {
            EXPECT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
            const ToolContact& last = play.contacts().back();
            ratios.push_back(last.normal() > 0.01 ? last.friction() / last.normal() : 0);
        }
        return ratios;
    };
    const auto felt =
        stroked("kind = \"touch\"\n", "touch = { stiffness = 500, friction = 0.4, sliding = 0.4 }\n");
    const auto pressed =
        stroked("kind = \"press\"\nstiffness = 500\nfriction = 0.4\nsliding = 0.4\ndamping = 1\n", "");
    const auto smooth = stroked("kind = \"touch\"\n", "touch = { stiffness = 500, friction = 0 }\n");
    for (std::size_t frame = 100; frame < 118; ++frame) {
        EXPECT_LE(std::abs(felt[frame] - pressed[frame]), 0.04) << frame;
        EXPECT_GE(felt[frame], 0.25) << frame;
        EXPECT_LE(felt[frame], 0.5) << frame;
        EXPECT_LE(smooth[frame], 0.15) << frame;
    }
}

// A sheet is felt from both sides, and does not let the hand through.
TEST(Play, AHandFeelsAClothFromBothSides) {
    std::vector<int> border;
    for (int i = 0; i < 21 * 21; ++i)
        if (i % 21 % 20 == 0 || i / 21 % 20 == 0) border.push_back(i);
    auto felt_from = [&](int side) {
        const Report report =
            run(scene(fmt::format(
                    "[simulation]\nduration = 2.5\ngravity = [0, 0, 0]\n"
                    "[[body]]\nname = \"sheet\"\ncloth = [21, 21]\nspacing = 0.005\n"
                    "springs = {{ structural = 40, shear = 20, flexion = 5 }}\ndensity = 0.3\ndamping = 5\n"
                    "pin = {{ nodes = [{4}] }}\ntouch = {{ stiffness = 300 }}\n"
                    "[[tool]]\nkind = \"touch\"\nradius = 0.012\n"
                    "from = [0.05, 0.05, {0}]\nalong = [0, 0, {1}]\n"
                    "path = [[0, 0, 0, {2}], [1.2, 0, 0, {2}], [1.5, 0, 0, {3}], [3, 0, 0, {3}]]\n",
                    0.3 * side, -side, 0.003 * side, -0.012 * side, fmt::join(border, ","))),
                {});
        EXPECT_FALSE(report.diverged);
        return report.tools[0];
    };
    const Report::Tool above = felt_from(1), below = felt_from(-1);
    EXPECT_GT(above.force.back(), 0.02);
    EXPECT_GT(above.indentation.back(), 0.004);
    EXPECT_LE(std::abs(above.force.back() / below.force.back() - 1), 0.02);
    EXPECT_LE(std::abs(above.indentation.back() / below.indentation.back() - 1), 0.02);
}

// A surface is no stiffer than the device can render, also to the body; and a hand that begins inside presses
// nothing.
TEST(Play, AHandPressesAsStifflyAsItsDeviceCan) {
    const std::string touch = "kind = \"touch\"\n";
    const Report most = press_by(touch, "touch = { stiffness = 500 }\n"),
                 more = press_by(touch, "touch = { stiffness = 20000 }\n");
    EXPECT_EQ(most.tools[0].force.back(), more.tools[0].force.back());
    const Report inside = run(
        scene("[simulation]\nduration = 2\n[[body]]\nname = \"block\"\ndims = [11, 7, 11]\nspacing = 0.006\n"
              "youngs_modulus = 4000\ndensity = 1000\ndamping = 10\npin = { below = 0 }\n"
              "[[tool]]\nkind = \"touch\"\nradius = 0.012\npath = [[0, 0.03, 0.03, 0.03], [3, 0.03, 0.03, "
              "0.03]]\n"),
        {});
    EXPECT_EQ(inside.tools[0].largest_force, 0);
    EXPECT_EQ(inside.bodies[0].inverted_cells, 0u);
}

// What the hand has felt, the body has got, also while the force ramps up. (When the body flies off, the
// passivity control takes from what the hand would feel.)
TEST(Play, AHandGivesABodyTheMomentumThatItFeels) {
    const Scene floating = scene(
        "[simulation]\nduration = 1.5\ngravity = [0, 0, 0]\n"
        "[[body]]\nname = \"block\"\ndims = [9, 5, 9]\nspacing = 0.006\nyoungs_modulus = 4000\n"
        "density = 1000\ntouch = { stiffness = 500 }\n"
        "[[tool]]\nkind = \"touch\"\nradius = 0.01\nfrom = [0.024, 0.3, 0.024]\n"
        "path = [[0, 0, 0.001, 0], [0.2, 0, 0.001, 0], [1.2, 0, -0.05, 0], [2, 0, -0.05, 0]]\n");
    const Models made = build(floating);
    Report report;
    Play play(floating, made, report);
    double felt = 0;  // N s
    for (int frame = 0; frame < 22; ++frame) {
        ASSERT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
        felt += report.tools[0].force.back() * frame_seconds;
    }
    double got = 0;
    const State state = play.states()[0];
    const Body& body = made.models[0].body;
    for (std::size_t i = 0; i < body.count(); ++i)
        got -= state.velocities[i].y / double(body.inverse_mass[i]);
    EXPECT_GT(got, 0.003);
    EXPECT_LE(std::abs(felt / got - 1), 0.01);
}

// It dents what nothing simulates, and that alone.
TEST(Play, AHandDentsOnlyWhatStandsStill) {
    Scratch scratch;
    Scene standing = felt_scene(scratch, "{ stiffness = 300 }", "script");
    standing.tools[0].kind = ToolKind::touch;
    const Report report = run(standing, {});
    EXPECT_LE(std::abs(report.tools[0].largest_force - 300 * 0.004), 0.01 * 300 * 0.004);
    const Scene soft = scene(
        "[[body]]\nname = \"block\"\ndims = [9, 5, 9]\nspacing = 0.006\n"
        "youngs_modulus = 4000\ndensity = 1000\npin = { below = 0 }\n"
        "[[tool]]\nkind = \"touch\"\nradius = 0.01\nfrom = [0.024, 0.3, 0.024]\n"
        "path = [[0, 0, 0.002, 0], [1.1, 0, 0.002, 0], [1.3, 0, -0.004, 0], [3, 0, -0.004, 0]]\n");
    const Models made = build(soft);
    Report of_soft;
    Play play(soft, made, of_soft);
    for (int frame = 0; frame < 100; ++frame) ASSERT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
    EXPECT_GT(of_soft.tools[0].force.back(), 0.02);
    EXPECT_TRUE(play.dents(0).empty());
}

}  // namespace
}  // namespace palpate
