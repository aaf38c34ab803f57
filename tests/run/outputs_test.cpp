// What a run writes: pictures, films, plots, reports, surfaces and sequences.
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "palpate/run/plot.h"
#include "palpate/run/run.h"
#include "tests/refusal.h"
#include "tests/run/pressed.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

namespace palpate {
namespace {

// Longer frames than a film's: it goes on as fast as the scene.
TEST(Run, LongStepsStillMakeEvenSequences) {
    Scratch scratch;
    RunSettings settings;
    settings.steps = 7;
    settings.sequence = scratch / "s.ply";
    settings.sequence_every = 0.049;  // three frames of 1/60 s
    const Report report =
        run(scene({"simulation.step=0.012", "body.block.youngs_modulus=100", "tool.finger.stiffness=5"}),
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

TEST(Run, AFolderThatCannotBeMadeIsSaidBeforeTheWork) {
    RunSettings settings;
    settings.report = "/proc/no/such/report.json";
    EXPECT_THROW(run(scene(), settings), Error);
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

}  // namespace
}  // namespace palpate
