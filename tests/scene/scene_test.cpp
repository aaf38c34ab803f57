#include "palpate/scene/scene.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/scene/build.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

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
    return palpate::refusal([&] { parse(text, changes); });
}

void expect_words(const std::string& message, std::initializer_list<std::string> words) {
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
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
    expect_words(refusal(small + "[[tool]]\nname = \"a/b\"\npath = [[0, 0, 0, 0]]\n"), {"slash"});
    expect_words(refusal(small + "[[tool]]\npath = [[0, 0, 0, 1e300]]\n"), {"world"});
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
             {"nodes", "9223372036854775807",
              "is 9223372036854775807, not a whole number of a sensible size"},
             {"cage", "[9007199254740993, 2, 2]", "9007199254740993, not a whole number of a sensible size"},
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
    expect_words(refusal("[camera]\nup = [0, 0, 0]\n" + small), {"camera.up", "direction"});
    expect_words(refusal("[light]\ndirection = [0, 0, 0]\n" + small), {"light.direction", "direction"});
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
             {"youngs_modulus = 20,000", "with a point: 20.000, or 20000 if the comma parts thousands"},
             {"youngs_modulus = \"20,000\"", "20.000, or 20000"},
             {"damping = 0,250", "with a point: 0.250"},
             {"mapping = constant", "write texts in quotes: mapping = \"constant\""},
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
    expect_words(refusal(small + "poisson = 0.45\n"), {"\"poisson\" of body.cube", "line 8", "always 1/4"});
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

// A body's keys but its name, and the words of the refusal.
void expect_body(const std::string& keys, std::initializer_list<std::string> words) {
    expect_words(refusal("[[body]]\nname = \"flag\"\n" + keys), words);
}

TEST(Scene, ReadsClothAndSprings) {
    const Scene scene = parse(R"(
[[body]]
cloth = [20, 30]
spacing = 0.01
springs = { structural = 200, shear = 20, flexion = 2 }
density = 0.2
link_damping = 0.001
[[body]]
surface = "flag.ply"
sheet = true
mass = 0.1
[[body]]
dims = [3, 4, 5]
spacing = 0.01
springs = { structural = 7 }
density = 1000
rotate = [0, 90, 0]
)");
    const BodyRecipe &flag = scene.bodies.at(0), &sheet = scene.bodies.at(1), &box = scene.bodies.at(2);
    EXPECT_EQ(flag.cloth, ivec2(20, 30));
    EXPECT_EQ(flag.springs.value().shear, 20);
    EXPECT_EQ(flag.material.link_damping, 0.001f);
    EXPECT_TRUE(sheet.sheet);
    EXPECT_FALSE(sheet.springs);
    EXPECT_EQ(box.springs.value().structural, 7);
    EXPECT_EQ(box.springs->flexion, 0);
    EXPECT_EQ(box.rotate, vec3(0, 90, 0));
}

TEST(Scene, ClothThatDoesNotFit) {
    const std::string grid = "cloth = [3, 3]\nspacing = 0.01\n", weight = "density = 0.2\n";
    expect_body("cloth = [3, 3, 3]\n" + weight, {"cloth", "two numbers"});
    expect_body("cloth = [0, 3]\nspacing = 1\n" + weight, {"flag.cloth", "not from 1"});
    expect_body("cloth = [3, 3]\n" + weight, {"cloth without spacing"});
    expect_body(grid + weight + "surface = \"x.ply\"\n", {"exactly one"});
    expect_body(grid + weight + "youngs_modulus = 10\n", {"youngs_modulus", "springs"});
    expect_body(grid + weight + "stiffness = 10\n", {"stiffness", "springs"});
    expect_body(grid + weight + "springs = 3\n", {"springs", "table"});
    expect_body(grid + weight + "springs = { bending = 3 }\n", {"bending", "springs"});
    expect_body(grid + weight + "springs = { structural = 0 }\n", {"structural"});
    expect_body(grid + weight + "springs = { structural = 1, shear = -1 }\n", {"springs", "negative"});
    expect_body(grid + weight + "links = \"cells\"\n", {"links"});
    expect_body(grid + weight + "sheet = true\n", {"sheet without a surface"});
    expect_body(grid + weight + "link_damping = -1\n", {"negative"});
    expect_body(grid, {"one of density and mass", "none", "kg/m²"});
    expect_body("surface = \"x.ply\"\nsheet = true\nspacing = 0.1\n" + weight, {"sheet", "spacing"});
    expect_body("surface = \"x.ply\"\nspacing = 0.1\nsprings = { structural = 1 }\n" + weight,
                {"springs are for"});
    expect_words(refusal(small + "springs = { structural = 1 }\n"), {"springs", "youngs_modulus"});
}

TEST(Scene, Regions) {
    const Scene scene = parse(small + R"(
[[body.region]]
near = [0, 0, 0]
radius = 0.01
factor = 3
[[body.region]]
labels = "parts.nii"
label = 3
youngs_modulus = 20000
)",
                              {"body.cube.region.1.factor=4"});
    const auto& regions = scene.bodies[0].regions;
    ASSERT_EQ(regions.size(), 2u);
    EXPECT_EQ(regions[0].factor, 4);
    EXPECT_EQ(regions[0].choice.radius, 0.01f);
    EXPECT_EQ(regions[1].label, 3.0f);
    const std::string region = small + "[[body.region]]\n";
    expect_words(refusal(region + "factor = 2\n"), {"cube", "region", "line 8", "which nodes"});
    expect_words(refusal(region + "near = [0, 0, 0]\n"), {"exactly one of", "factor"});
    expect_words(refusal(region + "near = [0, 0, 0]\nfactor = 2\nstiffness = 3\n"), {"exactly one of"});
    expect_words(refusal(region + "near = [0, 0, 0]\nfactor = -2\n"), {"factor", "not above 0"});
    expect_words(refusal(region + "labels = \"x.nii\"\nfactor = 2\n"), {"labels and label"});
    expect_words(refusal(region + "label = 3\nnodes = [0]\nfactor = 2\n"), {"labels and label"});
    expect_words(refusal(region + "radius = 3\nnodes = [0]\nfactor = 2\n"), {"radius without near"});
    expect_words(refusal(region + "boxes = 3\n"), {"\"boxes\"", "\"box\""});
    const std::string cloth = "[[body]]\ncloth = [3, 3]\nspacing = 1\ndensity = 1\n[[body.region]]\n";
    expect_words(refusal(cloth + "nodes = [0]\nyoungs_modulus = 2\n"), {"give it a factor"});
}

TEST(Scene, MapsAndShade) {
    const std::string cow =
        "[[body]]\nname = \"cow\"\nsurface = \"cow.obj\"\nmass = 1\nyoungs_modulus = 5000\n";
    const BodyRecipe plain = parse(cow).bodies[0];
    EXPECT_FALSE(plain.is_textured());
    EXPECT_EQ(plain.shade, Shade::colour);
    const BodyRecipe worn =
        parse(cow + "colour_map = \"cow.png\"\nnormal_map = \"hair.png\"\nshade = \"normals\"\n").bodies[0];
    EXPECT_EQ(worn.colour_map, "cow.png");
    EXPECT_EQ(worn.normal_map, "hair.png");
    EXPECT_EQ(worn.shade, Shade::normals);
    EXPECT_EQ(worn.colour, vec3(1));  // as painted
    EXPECT_EQ(parse(cow + "colour_map = \"cow.png\"\ncolour = [1, 0, 0]\n").bodies[0].colour, vec3(1, 0, 0));
    EXPECT_EQ(parse(cow + "weave = [60, 40]\n").bodies[0].weave, ivec2(60, 40));
    expect_words(refusal(cow + "color_map = \"cow.png\"\n"), {"color_map", "\"colour_map\"", "line 6"});
    expect_words(refusal(cow + "shade = \"normal\"\n"), {"normal", "colour, normals"});
    expect_words(refusal(cow + "weave = [0, 40]\n"), {"body.cow.weave", "1 to 128"});
    expect_words(refusal(cow + "weave = [2, 4]\nnormal_map = \"hair.png\"\n"), {"weave", "normal_map"});
    const std::string map = "colour_map = \"cow.png\"\n";
    expect_words(refusal(cow + map + "faces = 500\n"), {"body cow", "faces", "texture coordinates"});
    expect_words(refusal(cow + map + "smooth = 3\n"), {"smooth", "texture coordinates"});
    expect_words(refusal(small + map), {"body cube", "no texture coordinates"});
    // Another surface does not wear what was made for this one.
    EXPECT_FALSE(parse_scene(cow + map, "test.toml", ".", std::vector<Change>{"body.cow.surface=horse.obj"})
                     .bodies[0]
                     .is_textured());
}

TEST(Scene, WindAndAir) {
    EXPECT_EQ(parse(small).simulation.air, 0);
    EXPECT_TRUE(parse(small).wind.empty());
    EXPECT_EQ(parse(small + "[simulation]\nair = 1000\n").simulation.air, 1000);
    const Scene steady = parse(small + "[wind]\nvelocity = [3, 0, 0]\n");
    EXPECT_EQ(steady.simulation.air, 1.2f);
    EXPECT_EQ(position(steady.wind, 7), vec3(3, 0, 0));
    const Scene gusts = parse(small + "[wind]\npath = [[1, 3, 0, 0], [2, 5, 0, 0]]\ndensity = 1.1\n");
    EXPECT_EQ(gusts.simulation.air, 1.1f);
    EXPECT_EQ(position(gusts.wind, 0), vec3(3, 0, 0));
    EXPECT_EQ(position(gusts.wind, 1.5), vec3(4, 0, 0));
    const Scene both = parse(small + "[wind]\nvelocity = [3, 0, 0]\n[simulation]\nair = 2\n");
    EXPECT_EQ(both.simulation.air, 2);
    expect_words(refusal(small + "[wind]\n"), {"line 8", "velocity and path"});
    expect_words(refusal(small + "[wind]\nvelocity = 3\n"), {"velocity", "three numbers"});
    expect_words(refusal(small + "[wind]\nvelocity = [1, 0, 0]\npath = [[0, 1, 0, 0]]\n"), {"one of them"});
    expect_words(refusal(small + "[wind]\nvelocity = [1, 0, 0]\ndensity = 1\n[simulation]\nair = 1\n"),
                 {"twice"});
    expect_words(refusal(small + "[wind]\nvelocity = [1, 0, 0]\ndensity = -1\n"), {"negative"});
    expect_words(refusal(small + "[simulation]\nair = -1\n"), {"negative"});
    EXPECT_EQ(parse(small).simulation.threads, 1);
    EXPECT_EQ(parse(small + "[simulation]\nthreads = 2\n").simulation.threads, 2);
    for (const char* threads : {"0", "-3", "100000"})
        expect_words(refusal(small + "[simulation]\nthreads = " + threads + "\n"), {"threads", "256"});
    expect_words(refusal(small + "[wind]\npath = [[0, 1, 0, 0, 90, 0, 0]]\n"), {"row 1", "rotation"});
}

TEST(Scene, EveryKindOfCollider) {
    const Scene scene = parse(small + R"(
[[collider]]
capsule = { from = [0, 0, 0], to = [0, 1, 0], radius = 0.1 }
friction = 0.4
margin = 0.002
colour = [1, 0, 0]
path = [[0, 0, 0, 0, 0, 0, 0], [1, 0, 0.1, 0, 0, 90, 0]]
about = [0, 0, 0]
[[collider]]
box = { centre = [1, 2, 3], size = [0.2, 0.4, 0.6], rotate = [0, 0, 90], rounding = 0.01 }
[[collider]]
polygon = { triangles = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], thickness = 0.002 }
[[collider]]
polygon = { surface = "table.ply", units = "cm", move = [0, 1, 0] }
[[collider]]
field = { surface = "bunny.ply", spacing = 0.01, rotate = [90, 0, 0] }
)");
    const auto& all = scene.colliders;
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(std::get<Capsule>(all[0].collider.shape).to, vec3(0, 1, 0));
    EXPECT_EQ(all[0].collider.friction, 0.4f);
    EXPECT_EQ(all[0].collider.margin, 0.002f);
    EXPECT_EQ(all[0].path.at(1).rotation, vec3(0, 90, 0));
    EXPECT_EQ(all[0].about, vec3(0));
    const Box& box = std::get<Box>(all[1].collider.shape);
    EXPECT_EQ(box.half, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_LT(glm::distance(box.axes[0], vec3(0, 1, 0)), 1e-6f);
    EXPECT_EQ(std::get<Polygon>(all[2].collider.shape).triangles.at(0)[1], vec3(1, 0, 0));
    EXPECT_EQ(all[3].units, Units::centimetres);
    EXPECT_EQ(all[3].move, vec3(0, 1, 0));
    EXPECT_EQ(std::get<DistanceField>(all[4].collider.shape).spacing, 0.01f);
}

TEST(Scene, CollidersThatDoNotFit) {
    auto refuse = [&](const std::string& keys, std::initializer_list<std::string> words) {
        expect_words(refusal(small + "[[collider]]\n" + keys + "\n"), words);
    };
    refuse("capsule = { radius = 0 }", {"collider.1.capsule.radius is 0 m", "line 9"});
    refuse("capsule = { form = 3 }", {"\"form\"", "\"from\""});
    refuse("sphere = { radius = -1 }", {"sphere"});
    refuse("plane = { normal = [0, 0, 0] }", {"plane", "zero"});
    refuse("box = { centre = [0, 0, 0] }", {"half and size"});
    refuse("box = { half = [1, 1, 1], size = [1, 1, 1] }", {"half and size"});
    refuse("box = { half = [1, 0, 1] }", {"box", "above zero"});
    refuse("box = { half = [1, 1, 1], rounding = -0.1 }", {"rounding"});
    refuse("polygon = {}", {"surface and triangles"});
    refuse("polygon = { triangles = [] }", {"without a triangle"});
    refuse("polygon = { triangles = [[[0, 0, 0], [1, 0, 0]]] }", {"three corners"});
    refuse("polygon = { triangles = [[[0, 0, 0], [1, 0, 0], [2, 0, 0]]] }", {"no area"});
    refuse("polygon = { surface = \"x.ply\", thickness = 0 }", {"thickness"});
    refuse("polygon = { triangles = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], units = \"m\" }", {"units"});
    refuse("field = {}", {"field without a surface"});
    refuse("field = { surface = \"x.ply\", spacing = -1 }", {"spacing"});
    refuse("plane = {}\nfriction = -1", {"friction"});
    refuse("plane = {}\nmargin = -1", {"margin"});
    refuse("plane = {}\nabout = [0, 0, 0]", {"about without a path"});
    refuse("plane = {}\npath = [[0, 0, 0, 0], [1, 0, 0, 0, 0, 90, 0]]", {"row 2", "as long as the first"});
    refuse("plane = {}\npath = [[0, 0, 0, 0, 0]]", {"four or seven"});
    refuse("plane = {}\npath = []", {"without a row"});
    refuse("ball = {}", {"ball"});
    std::string many = small;
    for (int i = 0; i < 17; ++i) many += "[[collider]]\nplane = {}\n";
    expect_words(refusal(many), {"16 colliders"});
}

TEST(Scene, Moves) {
    const Scene scene = parse(small + R"(
[[move]]
nodes = { below = 0.1, near = [0, 0, 0], radius = 0.01 }
path = [[0, 0, 0, 0, 0, 0, 0], [1, 0.1, 0, 0, 0, 90, 0]]
)");
    EXPECT_EQ(scene.moves.at(0).body, "cube");
    EXPECT_EQ(scene.moves[0].nodes.below, 0.1f);
    EXPECT_LT(
        glm::distance(pose(scene.moves[0].path, 0.5).rotation[0], vec3(std::sqrt(0.5f), 0, -std::sqrt(0.5f))),
        1e-6f);
    const std::string path = "path = [[0, 0, 0, 0]]\n", nodes = "nodes = { below = 0.1 }\n";
    expect_words(refusal(small + "[[move]]\n" + nodes), {"move 1", "line 8", "path"});
    expect_words(refusal(small + "[[move]]\n" + path), {"which nodes"});
    expect_words(refusal(small + "[[move]]\nnodes = [1]\n" + path), {"nodes", "table"});
    expect_words(refusal(small + "[[move]]\nnodes = { box = [[0, 0, 0]] }\n" + path), {"nodes.box"});
    expect_words(refusal(small + "[[move]]\nbody = \"cub\"\n" + nodes + path), {"\"cub\"", "cube"});
    std::string second = small;
    second.replace(second.find("cube"), 4, "ball");
    expect_words(refusal(small + second + "[[move]]\n" + nodes + path), {"which body", "ball, cube"});
}

TEST(Scene, Drags) {
    const Scene scene = parse(small + R"(
[[tool]]
kind = "drag"
body = "cube"
near = [0.1, 0, 0]
relative = true
path = [[0, 0, 0, 0], [1, 0.1, 0, 0]]
)");
    EXPECT_EQ(scene.tools[0].kind, ToolKind::drag);
    EXPECT_EQ(scene.tools[0].stiffness, 50);
    EXPECT_EQ(scene.tools[0].near, vec3(0.1f, 0, 0));
    const std::string path = "path = [[0, 0, 0, 0]]\n", drag = "[[tool]]\nkind = \"drag\"\n";
    expect_words(refusal(small + drag), {"tool1", "path"});
    expect_words(refusal(small + drag + path + "from = [0, 0, 0]\n"), {"from", "drag"});
    expect_words(refusal(small + drag + path + "body = \"cub\"\n"), {"\"cub\"", "cube"});
    expect_words(refusal(small + drag + path + "relative = true\n"), {"relative", "near"});
    expect_words(refusal(small + drag + path + "stiffness = 0\n"), {"stiffness"});
    expect_words(refusal(small + "[[tool]]\nnear = [0, 0, 0]\n" + path), {"near", "press"});
    expect_words(refusal(small + drag + "path = [[0, 0, 0, 0, 90, 0, 0]]\n"), {"rotation"});
}

TEST(Scene, SurfacesThatNothingMovesAndWhatFeelsThem) {
    const std::string skin = R"(
[[surface]]
name = "skin"
surface = "skin.obj"
move = [0, 0.1, 0]
touch = { stiffness = 250, damping = 0.5, friction = 0.1, width = 0.004, yield = 0.002 }
)";
    const std::string path = "path = [[0, 0, 0, 0], [1, 0, -0.1, 0]]\n",
                      dent = "[[tool]]\nkind = \"dent\"\n" + path;
    const Scene scene = parse(skin + dent + "shaft = 0.1\ndevice = \"hand\"\n", {"surface.skin.faces=500"});
    ASSERT_EQ(scene.surfaces.size(), 1u);
    EXPECT_TRUE(scene.bodies.empty());
    const BodyRecipe& one = scene.surfaces[0];
    EXPECT_EQ(one.surface, "skin.obj");
    EXPECT_EQ(one.faces, 500);
    EXPECT_EQ(one.feel.stiffness, 250);
    EXPECT_EQ(one.feel.damping, 0.5);
    EXPECT_EQ(one.feel.friction.still, 0.1);
    EXPECT_EQ(one.feel.friction.sliding, 0.1);  // what slides holds no better than what sticks
    EXPECT_EQ(one.feel.dent_width, 0.004);
    EXPECT_EQ(one.feel.yield, 0.002);
    EXPECT_EQ(scene.tools[0].kind, ToolKind::dent);
    EXPECT_EQ(scene.tools[0].shaft, 0.1f);
    EXPECT_TRUE(std::isinf(parse(small).bodies[0].feel.yield));

    expect_words(refusal("[simulation]\n"), {"no body"});
    expect_words(refusal("[[surface]]\n"), {"surface1", "volume"});
    expect_words(refusal(skin + "nodes = 100\n"), {"nodes", "surface"});
    expect_words(refusal(skin + skin), {"second", "skin"});
    std::string cube = skin;
    cube.replace(cube.find("skin"), 4, "cube");
    expect_words(refusal(small + cube), {"second", "cube"});
    expect_words(refusal(small + "touch = { stiffness = 0 }\n"), {"cube", "touch.stiffness"});
    expect_words(refusal(small + "touch = { width = -1 }\n"), {"touch.width"});
    expect_words(refusal(small + "touch = { friction = 0.1, sliding = 0.2 }\n"), {"sliding", "friction"});
    expect_words(refusal(small + "touch = { stifness = 3 }\n"), {"stifness", "\"stiffness\""});
    expect_words(refusal(small + dent + "stiffness = 100\n"), {"stiffness", "dent", "touch"});
    expect_words(refusal(small + dent + "near = [0, 0, 0]\n"), {"near", "dent"});
    expect_words(refusal(small + dent + "device = \"spoon\"\n"), {"spoon", "script", "hand"});
    expect_words(refusal(small + "[[tool]]\ndevice = \"hand\"\n" + path), {"hand", "press"});
    expect_words(refusal(small + dent + "shaft = -1\n"), {"shaft"});
    expect_words(refusal(skin + "[[move]]\nbody = \"skin\"\nnodes = { below = 1 }\n" + path),
                 {"no body", "skin"});
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
    expect_words(palpate::refusal([] { read_scene("no-such-scene"); }), {"no-such-scene", "brain", "box"});
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
    // As a spreadsheet writes it where commas are decimal.
    for (const char* text : {"t;x;y;z\n0;0;0;0\n2;1,5;0;-0,1\n", "0\t0\t0\t0\n2\t1,5\t0\t-0.1\n"}) {
        write_text(scratch / "comma.csv", text);
        EXPECT_EQ(read_path(scratch / "comma.csv").at(1).position, vec3(1.5f, 0, -0.1f)) << text;
    }
    write_text(scratch / "mixed.csv", "0,0,0,0\n1,0,5,0,1,0\n");
    expect_words(palpate::refusal([&] { read_path(scratch / "mixed.csv"); }),
                 {"mixed.csv", "line 2", "semicolons"});
    for (const char* bad : {"", "t,x,y,z\n", "0,0,0\n", "0,0,0,nan\n", "0,0,0,0\n0,0,0,0\n", "0,0,0,0x\n",
                            "0,0.04,0.2,O.04\n1,0,0,0\n", "0,0,0,1e300\n", "0,0,0,0\nt,x,y,z"}) {
        write_text(scratch / "bad.csv", bad);
        EXPECT_THROW(read_path(scratch / "bad.csv"), Error) << bad;
    }
}

TEST(Path, TurnsEvenlyInDegrees) {
    Scratch scratch;
    write_text(scratch / "turn.csv", "t,x,y,z,rx,ry,rz\n1,0,0,0,0,0,0\n2,0,0,1,0,0,270\n");
    const Path path = read_path(scratch / "turn.csv", Rows::poses);
    // A third of the way, and not the short way round.
    const Pose third = pose(path, 1 + 1.0 / 3);
    EXPECT_LT(glm::distance(third.rotation * vec3(1, 0, 0), vec3(0, 1, 0)), 1e-6f);
    EXPECT_NEAR(third.position.z, 1.0f / 3, 1e-6f);
    EXPECT_EQ(pose(path, 0).rotation, mat3(1));
    EXPECT_LT(glm::distance(pose(path, 9).rotation * vec3(1, 0, 0), vec3(0, -1, 0)), 1e-6f);
    EXPECT_THROW(read_path(scratch / "turn.csv"), Error);
    // About x, then y, then z, like a mesh.
    Mesh mesh;
    mesh.positions = {{1, 2, 3}};
    rotate(mesh, {30, 50, 70});
    EXPECT_LT(glm::distance(turn({30, 50, 70}) * vec3(1, 2, 3), mesh.positions[0]), 1e-6f);
    for (const char* bad : {"0,0,0,0,0,0\n", "0,0,0,0\n1,0,0,0,0,0,0\n", "0,0,0,0,0,0,1e30\n"}) {
        write_text(scratch / "bad.csv", bad);
        EXPECT_THROW(read_path(scratch / "bad.csv", Rows::poses), Error) << bad;
    }
}

}  // namespace
}  // namespace palpate
