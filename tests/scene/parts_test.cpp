// The parts of a scene: cloth, regions, maps, wind, colliders, moves, tools, surfaces and paths.
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/scene/scene.h"
#include "tests/scene/parsing.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

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
bending = 1e-5
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
    EXPECT_EQ(sheet.bending, 1e-5f);
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
    expect_body(grid + weight + "bending = 1e-5\n", {"bending", "not a sheet", "flexion"});
    expect_body("surface = \"x.ply\"\nsheet = true\nbending = -1\n" + weight, {"bending", "negative"});
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
    expect_words(refusal(small + map), {"body cube", "without texture coordinates"});
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
    refuse("polygon = { triangles = [[[0, 0, 0], [1, 0, 0], [2, 0, 0]]] }", {"degenerate triangle"});
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
    EXPECT_LT(glm::distance(pose(scene.moves[0].path, 0.5).turn * dvec3(1, 0, 0),
                            dvec3(std::sqrt(0.5), 0, -std::sqrt(0.5))),
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

TEST(Scene, PressesWithFriction) {
    const std::string path = "path = [[0, 0, 0, 0]]\n", press = small + "[[tool]]\n" + path;
    auto friction_of = [&](const std::string& keys) { return parse(press + keys).tools[0].friction; };
    EXPECT_EQ(friction_of(""), (Friction{0, 0}));
    EXPECT_EQ(friction_of("friction = 0.1\n"), (Friction{0.1, 0.1}));
    EXPECT_EQ(friction_of("friction = 0.5\n"), (Friction{0.5, 0.2}));
    EXPECT_EQ(friction_of("friction = 0.5\nsliding = 0.4\n"), (Friction{0.5, 0.4}));
    EXPECT_EQ(parse(press).tools[0].damping, 0);
    EXPECT_EQ(parse(press + "damping = 2\n").tools[0].damping, 2);
    for (const std::string key : {"friction", "sliding", "damping"}) {
        expect_words(refusal(press + key + " = -1\n"), {key, "-1"});
        for (const std::string kind : {"drag", "dent", "touch"})
            expect_words(refusal(press + "kind = \"" + kind + "\"\n" + key + " = 0.1\n"), {key, kind});
    }
    expect_words(refusal(press + "friction = 0.1\nsliding = 0.2\n"), {"sliding", "friction"});
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
    const std::string touch = "[[tool]]\nkind = \"touch\"\n" + path;
    EXPECT_EQ(parse(small + touch + "device = \"hand\"\n").tools[0].kind, ToolKind::touch);
    expect_words(refusal(small + touch + "stiffness = 100\n"), {"stiffness", "touch"});
    expect_words(refusal(small + dent + "near = [0, 0, 0]\n"), {"near", "dent"});
    expect_words(refusal(small + "[[tool]]\ndevice = \"hand\"\n" + path), {"hand", "press"});
    expect_words(refusal(small + dent + "shaft = -1\n"), {"shaft"});
    expect_words(refusal(skin + "[[move]]\nbody = \"skin\"\nnodes = { below = 1 }\n" + path),
                 {"no body", "skin"});
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
    expect_words(refusal([&] { read_path(scratch / "mixed.csv"); }), {"mixed.csv", "line 2", "semicolons"});
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
    EXPECT_LT(glm::distance(third.turn * dvec3(1, 0, 0), dvec3(0, 1, 0)), 1e-6);
    EXPECT_NEAR(third.place.z, 1.0 / 3, 1e-6f);
    EXPECT_EQ(pose(path, 0), Pose{});
    EXPECT_LT(glm::distance(pose(path, 9).turn * dvec3(1, 0, 0), dvec3(0, -1, 0)), 1e-6);
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
