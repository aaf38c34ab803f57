// How a scene is read, what is said of what cannot be, and how it is changed.
#include "palpate/scene/scene.h"

#include "palpate/base/error.h"
#include "palpate/body/tissues.h"
#include "tests/scene/parsing.h"

#include <gtest/gtest.h>

#include <array>

namespace palpate {
namespace {

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
    EXPECT_EQ(std::get<vec3>(scene.camera.look_at), vec3(0, 0.5f, 0));
    EXPECT_TRUE(scene.camera.orthographic);
    const BodyRecipe& brain = scene.bodies.at(0);
    EXPECT_EQ(brain.iso, 60.5f);
    EXPECT_EQ(brain.units, Units::millimetres);
    EXPECT_EQ(brain.nodes, 20'000);
    EXPECT_EQ(brain.pin.below, 0.15f);
    EXPECT_EQ(brain.pin.box.size(), 2u);
    EXPECT_EQ(brain.material.links, Links::equal);
    EXPECT_EQ(brain.mapping, Mapping::constant);
    EXPECT_EQ(std::get<Plane>(scene.colliders.at(0).collider.shape).normal, vec3(0, 1, 0));
    EXPECT_EQ(std::get<Sphere>(scene.colliders.at(1).collider.shape).radius, 0.2f);
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
    expect_words(refusal(small + "stiffness = 4\n"),
                 {"exactly one of youngs_modulus and stiffness", "has both", "line 8"});
    expect_words(refusal(small + small), {"second body", "cube"});
    expect_words(refusal("body = 3\n"), {"[[body]]"});
    expect_words(refusal(""), {"no body"});
    expect_words(refusal("[[body"), {"line 1", "test.toml"});
    expect_words(refusal(small + "[[tool]]\n"), {"path"});
    expect_words(refusal(small + "[[tool]]\npath = [[0, 0, 0, 0], [0, 1, 1, 1]]\n"),
                 {"row 2", "repeats the time of the row before"});
    expect_words(refusal(small + "[[tool]]\npath = \"no-such.csv\"\n"), {"no-such.csv"});
    expect_words(refusal(small + "[[tool]]\nkind = \"drill\"\npath = [[0, 0, 0, 0]]\n"), {"drill", "press"});
    expect_words(refusal(small + "[camera]\nlook_at = \"heart\"\n"), {"heart"});
    expect_words(refusal(small + "[[collider]]\n"), {"shape"});
    expect_words(refusal(small + "[[collider]]\nplane = {}\nsphere = {}\n"), {"two shapes"});
    expect_words(refusal(small + "smooth = 3\n"), {"dims", "smooth"});
    expect_words(refusal(small + "pin = { radius = 1 }\n"), {"pin.near"});
    const std::string press = small + "[[tool]]\npath = [[0, 0, 0, 0]]\n";
    expect_words(refusal(press + "pad = { width = [0.01, 0, 0] }\n"), {"a pad whose sides", "height ="});
    expect_words(refusal("[[surface]]\nsurface = \"a.ply\"\nshade = \"pressure\"\n"),
                 {"nothing simulates", "[[body]]"});
    expect_words(refusal(press + "pad = { rows = 0 }\n"), {"tool.1.pad.rows", "not from 1 to 100"});
    expect_words(refusal(press + "kind = \"dent\"\npad = { rows = 1 }\n"),
                 {"\"pad\" is not a key of a dent", "press"});
    expect_words(refusal(small + "[[tool]]\nname = \"a/b\"\npath = [[0, 0, 0, 0]]\n"), {"slash"});
    expect_words(refusal(small + "[[tool]]\npath = [[0, 0, 0, 1e300]]\n"), {"out of range"});
}

// The refusal names the key by its path, its value, its unit, what it may be, and the line.
TEST(Scene, EveryNumberHasItsRangeAndItsUnit) {
    const std::string mesh = "[[body]]\nname = \"cube\"\nsurface = \"x.ply\"\n";
    for (const auto& [key, value, words] : std::vector<std::array<std::string, 3>>{
             {"youngs_modulus", "0", "cube.youngs_modulus is 0 Pa, which is not above 0"},
             {"youngs_modulus", "-3", "not above 0"},
             {"stiffness", "-1", "N/m, which is not above 0"},
             {"density", "-1000", "cube.density is -1000 kg/m³, which is not above 0"},
             {"mass", "0", "0 kg, which is not above 0"},
             {"damping", "-1", "-1 1/s, which is negative"},
             {"link_damping", "-1", "-1 s, which is negative"},
             {"spacing", "0", "0 m, which is not from 1e-06 to 10000"},
             {"spacing", "1e30", "cube.spacing is 1e+30 m, which is not from 1e-06 to 10000"},
             {"spacing", "1e-30", "1e-30 m, which is not from 1e-06 to 10000"},
             {"move", "[1e30, 0, 0]", "cube.move is 1e+30 m, which is not from"},
             {"nodes", "9223372036854775807", "is 9223372036854775807, not a whole number of a valid size"},
             {"cage", "[9007199254740993, 2, 2]", "9007199254740993, not a whole number of a valid size"},
             {"nodes", "0", "not from 1"},
             {"size", "-1", "-1 m, which is negative"},
             {"faces", "-1", "negative"},
             {"smooth", "1001", "not from 0 to 1000"},
             {"specks", "1", "not from 0 to 0.999"},
             {"weld", "-1", "negative"},
             {"voxel", "-1", "negative"},
             {"shine", "2", "not from 0 to 1"},
             {"cage", "[0, 2, 2]", "not from 1"},
             {"pin", "{ below = 15 }", "cube.pin.below is 15, which is not from 0 to 1"},
             {"pin", "{ near = [0, 0, 0], radius = -1 }", "cube.pin.radius is -1 m, which is negative"},
             {"pin", "{ nodes = [-1] }", "cube.pin.nodes is -1, which is negative"},
             {"touch", "{ friction = -1 }", "cube.touch.friction"},
             {"touch", "{ damping = -1 }", "N·s/m, which is negative"}})
        expect_words(refusal(mesh + key + " = " + value + "\n"), {words, "test.toml, line 4"});
    for (const auto& [table, value, words] : std::vector<std::array<std::string, 3>>{
             {"[simulation]", "duration = 0", "simulation.duration is 0 s"},
             {"[simulation]", "threads = 1000", "not from 1 to 256"},
             {"[simulation]", "gravity = [0, 1e9, 0]", "simulation.gravity is 1e+09 m/s²"},
             {"[camera]", "angle = 180", "degrees, which is not from"},
             {"[light]", "colour = [200, 200, 200]", "light.colour is not from 0 to 10"},
             {"[[collider]]", "sphere = { radius = 0 }", "collider.1.sphere.radius is 0 m"},
             {"[[tool]]", "radius = 0", "tool.1.radius is 0 m"},
             {"[[tool]]", "stiffness = -4", "-4 N/m, which is not above 0"}})
        expect_words(refusal(small + table + "\n" + value + "\n"), {words, "test.toml, line 9"});
    expect_words(refusal("[camera]\nup = [0, 0, 0]\n" + small), {"camera.up", "line 2", "direction"});
    expect_words(refusal("[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 1]\n" + small),
                 {"camera.look_at", "line 3", "another point"});
    expect_words(refusal("[light]\ndirection = [0, 0, 0]\n" + small),
                 {"light.direction", "line 2", "direction"});
}

TEST(Scene, WholeNumbersMayBeWrittenAsOthersAre) {
    EXPECT_EQ(parse("[[body]]\nsurface = \"x.ply\"\nnodes = 2e4\nstiffness = 1\nmass = 1\n").bodies[0].nodes,
              20'000);
    expect_words(refusal(small + "damping = \"5\"\n"), {"\"5\"", "without quotes"});
    expect_words(refusal(small + "name = 3\n"), {"line 8"});
    expect_words(refusal("[[body]]\nsurface = \"x.ply\"\nnodes = 2.5\n"), {"2.5, not a whole number"});
}

TEST(Scene, DecimalCommasAreExplained) {
    expect_words(refusal(small + "damping = 0,5  # 1/s\n"), {"line 8", "with a point: 0.5"});
    expect_words(refusal(small + "damping = \"0,5\"\n"), {"line 8", "write 0.5"});
    expect_words(refusal(small + "move = [0,5, 1, 0]\n"), {"a list of 4", "with points in numbers"});
    expect_words(refusal(small, {"body.cube.damping=0,5"}), {"cube.damping", "--set", "write 0.5"});
    expect_words(refusal(small + "[[tool]]\npath = [[0,5, 0, 0, 0]]\n"), {"row 1", "with points in numbers"});
}

TEST(Scene, WhatPeopleWriteInsteadOfTomlIsExplained) {
    const std::string body = "[[body]]\nname = \"cube\"\ndims = [4, 4, 4]\nspacing = 0.01\ndensity = 1000\n";
    for (const auto& [line, words] : std::vector<std::array<std::string, 2>>{
             {"youngs_modulus = 20 kPa", "write the number alone, without kPa: youngs_modulus is in Pa"},
             {"youngs_modulus = 20,000", "with a point: 20.000, or 20000 if the comma separates thousands"},
             {"youngs_modulus = \"20,000\"", "20.000, or 20000"},
             {"damping = 0,250", "with a point: 0.250"},
             {"mapping = constant", "write strings in quotes: mapping = \"constant\""},
             {"move = [5; 5; 5]", "commas between the numbers in brackets"},
             {"move = [5 5 5]", "commas between the numbers in brackets"},
             {"solid = True", "write solid = true"},
             {"damping = ", "correct the TOML there"}})
        expect_words(refusal(body + line + "\n"), {words, "line 6"});
}

TEST(Scene, WhatAChangeSaysIsNotLookedForInTheFile) {
    expect_words(refusal(small, {"body.cube.weld=1"}), {"weld beside dims", "in --set;"});
    expect_words(refusal(small, {"collider.1={ sphere = {}, about = [0, 0, 0] }"}),
                 {"about without a path", "in --set;"});
    expect_words(refusal(small + "weld = 1\n"), {"weld beside dims", "in test.toml, line 8;"});
}

TEST(Scene, ColoursOf255AreExplained) {
    // 188 is half the light in sRGB.
    expect_words(refusal(small + "colour = [188, 255, 0]\n"),
                 {"cube.colour", "line 8", "[0.5, 1, 0]", "linear"});
    expect_words(refusal(small + "colour = [-0.1, 0, 0]\n"), {"cube.colour is negative", "from 0 to 1"});
    expect_words(refusal(small + "[light]\ncolour = [-1, 0, 0]\n"), {"light.colour is negative", "line 9"});
}

const std::string bare = "[[body]]\nname = \"cube\"\ndims = [4, 4, 4]\nspacing = 0.01\n";

TEST(Scene, ATissueIsAMaterial) {
    const Material brain = tissue_named("brain").material();
    EXPECT_EQ(parse(bare + "tissue = \"brain\"\n").bodies[0].material, brain);
    Material own = brain;
    own.youngs_modulus = 3000;
    own.damping = 0;
    EXPECT_EQ(parse(bare + "damping = 0\nyoungs_modulus = 3000\ntissue = \"brain\"\n").bodies[0].material,
              own);
    Material heavy = brain;
    heavy.density = 0;
    heavy.mass = 2;
    EXPECT_EQ(parse(bare + "tissue = \"brain\"\nmass = 2\n").bodies[0].material, heavy);
}

TEST(Scene, ATissueHasItsNameAndNoSprings) {
    expect_words(refusal(bare + "tissue = \"brian\"\n"),
                 {"no tissue \"brian\"", "test.toml, line 5", "did you mean \"brain\"?", "liver, kidney"});
    expect_words(refusal(bare + "tissue = 3\n"), {"cube.tissue is 3, not a string"});
    expect_words(refusal(bare + "material = \"brain\"\n"), {"did you mean \"tissue\"?"});
    for (const std::string other : {"stiffness = 3", "springs = { structural = 1 }"})
        expect_words(refusal(bare + "tissue = \"brain\"\n" + other + "\n"),
                     {"beside tissue", "line 6", "remove one"});
    expect_words(refusal(bare + "tissue = \"brain\"\nlinks = \"equal\"\n"),
                 {"links of a body of tissue", "line 6", "model = \"springs\""});
    expect_words(refusal(bare + "tissue = \"brain\"\ndensity = 900\nmass = 1\n"), {"both density and mass"});
    expect_words(refusal("[[body]]\ncloth = [4, 4]\nspacing = 0.01\ntissue = \"skin\"\n"),
                 {"cloth of a tissue", "line 4"});
}

// "small" has a modulus and a density.
TEST(Scene, ASolidIsOfTissueUnlessItsSpringsAreMeant) {
    auto material = [](const std::string& more, const std::vector<Change>& changes = {}) {
        return parse(small + more, changes).bodies[0].material;
    };
    EXPECT_TRUE(is_tissue(material("")));
    EXPECT_EQ(material("").poisson, 0.45f);
    EXPECT_TRUE(is_tissue(material("model = \"tissue\"\n")));
    EXPECT_TRUE(is_tissue(material("model = \"springs\"\n", {"body.cube.poisson=0.3"})));
    for (const char* of_springs : {"model = \"springs\"\n", "links = \"cells\"\n", "links = \"equal\"\n"}) {
        EXPECT_FALSE(is_tissue(material(of_springs))) << of_springs;
        expect_words(refusal(small + of_springs + "poisson = 0.4\n"), {"body cube", "springs", "remove "});
    }
    EXPECT_FALSE(is_tissue(material("poisson = 0.3\n", {"body.cube.model=springs"})));
    EXPECT_FALSE(is_tissue(material("poisson = 0.3\n", {"body.cube.stiffness=3"})));
    // What a named tissue says of other things stays.
    const Material brain = tissue_named("brain").material();
    const std::string named = bare + "tissue = \"brain\"\n";
    const Material by_stiffness = parse(named, {"body.cube.stiffness=3"}).bodies[0].material;
    EXPECT_EQ(by_stiffness.density, brain.density);
    EXPECT_EQ(by_stiffness.damping, brain.damping);
    const Material linked = parse(named, {"body.cube.links=equal"}).bodies[0].material;
    EXPECT_EQ(linked.youngs_modulus, brain.youngs_modulus);
    EXPECT_FALSE(is_tissue(linked));
    EXPECT_EQ(material("links = \"equal\"\n", {"body.cube.model=springs"}).links, Links::equal);
    EXPECT_FALSE(is_tissue(parse(bare + "tissue = \"brain\"\nmodel = \"springs\"\n").bodies[0].material));
    expect_words(refusal(bare + "density = 1\nstiffness = 1\nmodel = \"tissue\"\n"),
                 {"tissue with a stiffness of springs", "line 6"});
    const std::string flat = "[[body]]\ndims = [4, 5, 1]\nspacing = 0.1\nmass = 1\n";
    EXPECT_FALSE(parse(flat + "youngs_modulus = 1e4\n").bodies[0].bears_its_weight());
    expect_words(refusal(flat), {"exactly one of youngs_modulus and stiffness", "none"});
    expect_words(refusal(flat + "youngs_modulus = 1e4\npoisson = 0.4\n"), {"one node thick", "line 6"});
    expect_words(refusal(small + "model = \"solid\"\n"), {"model", "line 8", "tissue", "springs"});
}

TEST(Scene, AChangeOfTissueTakesAwayTheOldMaterial) {
    const Material skin = tissue_named("skin").material();
    EXPECT_EQ(parse(small, {"body.cube.tissue=skin"}).bodies[0].material, skin);
    Material light = skin;
    light.density = 900;
    EXPECT_EQ(parse(small, {"body.cube.density=900", "body.cube.tissue=skin"}).bodies[0].material, light);
}

TEST(Scene, OfSeveralKeysOne) {
    expect_words(refusal(small + "mass = 1\n"), {"cube", "exactly one of density and mass",
                                                 "both density and mass", "line 8", "remove one"});
    EXPECT_EQ(parse(small, {"body.cube.mass=3"}).bodies[0].material.mass,
              3);  // a change takes the other away
    EXPECT_EQ(parse(small, {"body.cube.mass=3"}).bodies[0].material.density, 0);
    EXPECT_EQ(parse(small, {"body.cube.stiffness=3"}).bodies[0].material.youngs_modulus, 0);
    expect_words(refusal(small + "nodes = 100\n"), {"nodes", "line 8"});
    const std::string mesh = "[[body]]\nname = \"it\"\nsurface = \"x.ply\"\nstiffness = 1\nmass = 1\n";
    expect_words(refusal(mesh + "nodes = 100\nspacing = 0.1\n"), {"nodes beside spacing", "line 6"});
    EXPECT_EQ(parse(mesh + "nodes = 100\n", {"body.it.spacing=0.01"}).bodies[0].spacing, 0.01f);
}

TEST(Scene, KeysThatBelongElsewhere) {
    expect_words(refusal(small + "nu = 0.45\n"),
                 {"\"nu\" of body.cube", "line 8", "did you mean \"poisson\"?"});
    expect_words(refusal(small + "poisson = 0.5\n"), {"poisson", "line 8", "0.45 to 0.49"});
    expect_words(refusal("[simulation]\n" + small + "gravity = [0, 0, 0]\n"),
                 {"did you mean simulation.gravity?"});
    expect_words(refusal(small + "[[collider]]\nplane = {}\nradius = 1\n"), {"radius", "of collider.1"});
    expect_words(refusal(small, {"youngs_modulus=3"}), {"did you mean body.cube.youngs_modulus?", "--set"});
    expect_words(refusal(small, {"duration=3"}), {"did you mean simulation.duration?"});
    expect_words(refusal(small, {"cube.nodes=3"}), {"did you mean body.cube?"});
    expect_words(refusal(small, {"body.nodes=3"}), {"which body", "body.cube.nodes=3"});
    expect_words(refusal(small, {"body.ball.nodes=3"}), {"no body named ball", "choose from cube"});
    expect_words(refusal(small, {"body.cube.density=-1"}), {"body.cube.density is -1 kg/m³", "in --set"});
    expect_words(refusal(small + "E = 3\n"), {"did you mean \"youngs_modulus\"?"});
    expect_words(refusal(small + "mesh = \"a.stl\"\n"), {"did you mean \"surface\"?"});
    expect_words(refusal(small + "zzz = 3\n"), {"\"zzz\"", "its keys are", "youngs_modulus"});
    expect_words(refusal(small + "colour_map = \"\"\n"), {"cube.colour_map is empty", "line 8"});
}

// The notes of a scene in one text.
std::string notes(const std::string& text, const std::vector<Change>& changes = {}) {
    std::string all;
    for (const std::string& note : parse(text, changes).notes) all += note + "\n";
    return all;
}

TEST(Scene, UnusualNumbersAreNoted) {
    EXPECT_EQ(notes(small), "");
    for (const auto& [change, words] : std::vector<std::array<std::string, 2>>{
             {"body.cube.youngs_modulus=3", "cube.youngs_modulus is 3 Pa: is its unit right?"},
             {"body.cube.youngs_modulus=5e9", "5e+09 Pa"},
             {"body.cube.density=1", "1 kg/m³"},
             {"body.cube.density=1e6", "1e+06 kg/m³"},
             {"simulation.gravity=[0,-981,0]", "simulation.gravity is -981 m/s²"},
             {"simulation.duration=5000", "5000 s"},
             {"body.cube.link_damping=2", "2 s"},
             {"collider.1={plane={offset=-500}}", "-500 m"},
             {"collider.1={sphere={radius=250}}", "250 m"}}) {
        const std::string said = notes(small, {change});
        EXPECT_NE(said.find(words), std::string::npos) << change << ": " << said;
    }
    const std::string other = "[[body]]\ncloth = [3, 3]\nspacing = 0.1\ndensity = 1000\n";
    EXPECT_NE(notes(other).find("1000 kg/m² (line 4)"), std::string::npos) << notes(other);
    EXPECT_EQ(notes(other, {"body.1.density=0.15"}), "");
}

TEST(Scene, ChangesAddOneToAList) {
    const Scene scene = parse(small, {"collider.1={plane={offset=-0.1}}", "collider.1.friction=0.5",
                                      "collider.2={sphere={centre=[0,1,0],radius=0.2}}"});
    ASSERT_EQ(scene.colliders.size(), 2u);
    EXPECT_EQ(scene.colliders[0].collider.friction, 0.5f);
    EXPECT_EQ(std::get<Sphere>(scene.colliders[1].collider.shape).radius, 0.2f);
    EXPECT_EQ(
        parse(small, {"body.2={name=\"b\",dims=[3,3,3],spacing=0.01,stiffness=9,mass=1}"}).bodies.size(), 2u);
    expect_words(refusal(small, {"collider.2={plane={}}"}), {"collider"});
    expect_words(refusal(small, {"collider.1=5"}), {"1={"});
    expect_words(refusal(small, {"body.3={dims=[3,3,3]}"}), {"2={"});
    expect_words(refusal(small, {"body.cube=7"}), {"2={"});
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
    expect_words(refusal([] { read_scene("no-such-scene"); }), {"no-such-scene", "brain", "box"});
    EXPECT_THROW(find_data("no-such-file.nii", "."), Error);
}

}  // namespace
}  // namespace palpate
