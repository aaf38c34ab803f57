#include "palpate/scene/scene.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/scene/build.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

const std::string small = R"(
[[body]]
name = "cube"
dims = [4, 4, 4]
spacing = 0.01
youngs_modulus = 5000
density = 1000
)";

Scene parse(const std::string& text, const std::vector<Change>& changes = {}) {
    return parse_scene(text, "test.toml", ".", changes);
}

// The message that a text is refused with.
std::string refusal(const std::string& text, const std::vector<Change>& changes = {}) {
    try {
        parse(text, changes);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

void expect_words(const std::string& message, std::initializer_list<std::string> words) {
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(Scene, ReadsWhatAPersonWrites) {
    const Scene scene = parse(R"(
[simulation]
integrator = "semi-implicit-euler"
step = 0.001
gravity = [0, 0, -9.81]
duration = 2
[camera]
eye = [1, 2, 3]
look_at = [0, 0.5, 0]
projection = "orthographic"
[[body]]
name = "brain"
volume = "ch2bet.nii.gz"
iso = 60.5
units = "mm"
rotate = [-90, 0, 0]
nodes = 20_000
youngs_modulus = 5_000
density = 1040
pin = { below = 0.15, nodes = [0, 3], near = [0, 1, 0], radius = 0.1, box = [[0, 0, 0], [1, 1, 1]] }
links = "equal"
mapping = "constant"
[[collider]]
plane = { normal = [0, 2, 0], offset = -0.1 }
[[collider]]
sphere = { centre = [1, 0, 0], radius = 0.2 }
[[tool]]
radius = 0.006
path = [[0, 0, 0, 0], [1, 0.1, 0, 0]]
)");
    EXPECT_EQ(scene.simulation.integrator, Integrator::semi_implicit_euler);
    EXPECT_EQ(scene.simulation.step, 0.001);
    EXPECT_EQ(scene.simulation.gravity, vec3(0, 0, -9.81f));
    EXPECT_EQ(std::get<vec3>(scene.look_at), vec3(0, 0.5f, 0));
    EXPECT_TRUE(scene.camera.orthographic);
    const BodyRecipe& brain = scene.bodies.at(0);
    EXPECT_EQ(brain.iso, 60.5f);
    EXPECT_EQ(brain.units, Units::millimetres);
    EXPECT_EQ(brain.nodes, 20'000);
    EXPECT_EQ(brain.pin.below, 0.15f);
    EXPECT_EQ(brain.pin.box.size(), 2u);
    EXPECT_EQ(brain.material.links, Links::equal);
    EXPECT_EQ(brain.mapping, Mapping::constant);
    EXPECT_EQ(std::get<Plane>(scene.simulation.colliders.at(0).shape).normal, vec3(0, 1, 0));
    EXPECT_EQ(std::get<Sphere>(scene.simulation.colliders.at(1).shape).radius, 0.2f);
    EXPECT_EQ(scene.tools.at(0).path.size(), 2u);
    EXPECT_EQ(position(scene.tools[0].path, 0.5), vec3(0.05f, 0, 0));
}

TEST(Scene, UnknownKeysNameTheNearestAndTheLine) {
    expect_words(refusal(small + "nods = 3\n"), {"\"nods\"", "line 8", "test.toml", "\"nodes\""});
    expect_words(refusal(small + "[simulaton]\n"), {"simulaton", "\"simulation\""});
    expect_words(refusal(small + "pin = { belov = 1 }\n"), {"belov", "\"below\"", "pin"});
    expect_words(refusal(small + "[[collider]]\nplane = { norml = [0, 1, 0] }\n"), {"norml", "\"normal\""});
}

TEST(Scene, WrongTypesAndValuesAreNamed) {
    expect_words(refusal(small + "nodes = \"many\"\n"), {"nodes", "whole number", "line 8"});
    expect_words(refusal(small + "nodes = 99999999999\n"), {"nodes"});
    expect_words(refusal(small + "damping = nan\n"), {"damping", "number"});
    expect_words(refusal(small + "damping = 1e300\n"), {"damping"});
    expect_words(refusal(small + "rotate = [1, 2]\n"), {"rotate", "three numbers"});
    expect_words(refusal(small + "mapping = \"best\"\n"), {"best", "trilinear"});
    expect_words(refusal(small + "[simulation]\nintegrator = \"rk9\"\n"), {"rk9", "verlet"});
    expect_words(refusal(small + "[simulation]\nstep = \"soon\"\n"), {"step", "auto"});
    expect_words(refusal(small + "[simulation]\nstep = -1\n"), {"step"});
    expect_words(refusal(small + "[simulation]\nduration = -1\n"), {"duration"});
    expect_words(refusal(small + "damping = -1\n"), {"cube", "negative"});
    expect_words(refusal(small + "volume = \"x\"\n"), {"cube", "exactly one"});
    expect_words(refusal(small + "stiffness = 4\n"), {"youngs_modulus or stiffness"});
    expect_words(refusal(small + small), {"second body", "cube"});
    expect_words(refusal("body = 3\n"), {"[[body]]"});
    expect_words(refusal(""), {"no body"});
    expect_words(refusal("[[body"), {"line 1", "test.toml"});
    expect_words(refusal(small + "[[tool]]\n"), {"path"});
    expect_words(refusal(small + "[[tool]]\npath = [[0, 0, 0, 0], [0, 1, 1, 1]]\n"), {"back in time"});
    expect_words(refusal(small + "[[tool]]\npath = \"no-such.csv\"\n"), {"no-such.csv"});
    expect_words(refusal(small + "[[tool]]\nkind = \"drill\"\npath = [[0, 0, 0, 0]]\n"), {"drill", "press"});
    expect_words(refusal(small + "[camera]\nlook_at = \"heart\"\n"), {"heart"});
    expect_words(refusal(small + "[[collider]]\n"), {"shape"});
    expect_words(refusal(small + "[[collider]]\nplane = {}\nsphere = {}\n"), {"two shapes"});
    expect_words(refusal(small + "rotate = [90, 0, 0]\n"), {"dims"});
    expect_words(refusal(small + "pin = { radius = 1 }\n"), {"pin.near"});
    expect_words(refusal(small + "[[tool]]\nname = \"a/b\"\npath = [[0, 0, 0, 0]]\n"), {"slash"});
    expect_words(refusal(small + "[[tool]]\npath = [[0, 0, 0, 1e300]]\n"), {"world"});
}

TEST(Scene, ChangesFromTheCommandLine) {
    EXPECT_EQ(parse(small, {"body.cube.spacing=0.02"}).bodies[0].spacing, 0.02f);
    EXPECT_EQ(parse(small, {"body.1.dims=[2, 3, 4]"}).bodies[0].dims, ivec3(2, 3, 4));
    EXPECT_EQ(parse(small, {"simulation.integrator=semi-implicit-euler"}).simulation.integrator,
              Integrator::semi_implicit_euler);
    EXPECT_EQ(parse(small, {"body.cube.pin.below=0.5"}).bodies[0].pin.below, 0.5f);
    expect_words(refusal(small, {"body.cube.nods=3"}), {"nods", "\"nodes\""});
    expect_words(refusal(small, {"body.ball.nodes=3"}), {"ball"});
    expect_words(refusal(small, {"body.cube.dims.x=3"}), {"dims"});
    expect_words(refusal(small, {"body=3"}), {"[[body]]"});
    expect_words(refusal(small, {"nothing"}), {"--set"});
    expect_words(refusal(small, {"=3"}), {"--set"});
    expect_words(refusal(small, {"body.cube.nodes="}), {"nodes"});
}

TEST(Scene, MissingFilesSayWhereTheyAreLookedFor) {
    expect_words(
        [] {
            try {
                read_scene("no-such-scene");
            } catch (const Error& error) {
                return std::string(error.what());
            }
            return std::string();
        }(),
        {"no-such-scene", "brain", "box"});
    EXPECT_THROW(find_data("no-such-file.nii", "."), Error);
}

TEST(Path, FromAFile) {
    Scratch scratch;
    write_text(scratch / "a.csv", "t,x,y,z\n0, 0, 0, 0\r\n\n2, 1, 0, -1e-1\n");
    const Path path = read_path(scratch / "a.csv");
    ASSERT_EQ(path.size(), 2u);
    EXPECT_EQ(position(path, 1), vec3(0.5f, 0, -0.05f));
    EXPECT_TRUE(within(path, 2));
    EXPECT_FALSE(within(path, 2.01));
    write_text(scratch / "mark.csv",
               "\xef\xbb\xbf"
               "0,1,2,3\n");
    EXPECT_EQ(read_path(scratch / "mark.csv").size(), 1u);
    for (const char* bad : {"", "t,x,y,z\n", "0,0,0\n", "0,0,0,nan\n", "0,0,0,0\n0,0,0,0\n", "0,0,0,0x\n",
                            "0,0.04,0.2,O.04\n1,0,0,0\n", "0,0,0,1e300\n", "0,0,0,0\nt,x,y,z"}) {
        write_text(scratch / "bad.csv", bad);
        EXPECT_THROW(read_path(scratch / "bad.csv"), Error) << bad;
    }
}

class Shipped : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Every, Shipped, ::testing::Values("brain", "head", "box"),
                         [](const auto& each) { return each.param; });

TEST_P(Shipped, BuildsAsItSays) {
    const Scene scene = read_scene(GetParam());
    if (!scene.bodies[0].volume.empty() &&
        !std::filesystem::exists("/usr/share/mricron/templates/ch2.nii.gz"))
        GTEST_SKIP() << "mricron-data is not available";
    const Models made = build(scene);
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const BodyRecipe& recipe = scene.bodies[m];
        const auto& [body, surface, embedding] = made.models[m];
        if (!recipe.dims) EXPECT_LE(std::abs(double(body.count()) / recipe.nodes - 1), 0.05);
        EXPECT_GT(surface.triangles.size(), 0u);
        std::size_t pinned = 0;
        for (float inverse : body.inverse_mass) pinned += inverse == 0;
        EXPECT_GT(pinned, 0u);
        EXPECT_LT(pinned, body.count() / 2);
    }
    EXPECT_TRUE(made.notes.empty()) << made.notes[0];
}

// 10,000 steps of the automatic length: nothing blows up, and what is damped comes to rest.
TEST_P(Shipped, IsStableAtTheAutomaticStep) {
    const Scene scene = read_scene(GetParam());
    if (!scene.bodies[0].volume.empty() &&
        !std::filesystem::exists("/usr/share/mricron/templates/ch2.nii.gz"))
        GTEST_SKIP() << "mricron-data is not available";
    const Models made = build(scene);
    for (const Model& model : made.models)
        for (Integrator integrator : {Integrator::verlet, Integrator::semi_implicit_euler}) {
            Simulation simulation = scene.simulation;
            simulation.integrator = integrator;
            auto solver = make_solver(model.body, simulation);
            Stats stats;
            for (int steps = 0; steps < 10'000; steps += stats.steps) {
                stats = solver->step(0.1);
                ASSERT_FALSE(stats.diverged) << name_of(integrator) << " after " << steps;
            }
            EXPECT_LE(stats.largest_speed, 0.02) << name_of(integrator);
        }
}

}  // namespace
}  // namespace palpate
