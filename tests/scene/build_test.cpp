// What build() makes of recipes.
#include "palpate/scene/build.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/image_file.h"
#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "tests/refusal.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

namespace palpate {
namespace {

const std::string cube = R"(
[[body]]
name = "cube"
dims = [6, 6, 6]
spacing = 0.004
youngs_modulus = 5000
density = 1000
)";

Models make(const std::string& text, const std::filesystem::path& folder = ".") {
    return build(parse_scene(text, "test.toml", folder));
}

// The message that making a scene is refused with.
std::string refusal(const std::string& text, const std::filesystem::path& folder) {
    return palpate::refusal([&] { make(text, folder); });
}

bool has_note(const Models& made, const std::string& words) {
    for (const std::string& note : made.notes)
        if (note.find(words) != std::string::npos) return true;
    return false;
}

TEST(Build, ABoxIsTurnedAndMovedWithItsSurface) {
    const Model there = make(cube + "rotate = [0, 0, 90]\nmove = [1, 2, 3]\n").models[0];
    const Model here = make(cube).models[0];
    for (std::size_t i = 0; i < here.body.count(); ++i) {
        const vec3 p = here.body.positions[i];
        EXPECT_LT(glm::distance(there.body.positions[i], vec3(1 - p.y, 2 + p.x, 3 + p.z)), 1e-6f);
    }
    // The surface lies where its nodes take it, and its normals with it.
    for (const Model& model : {here, there}) {
        std::vector<vec3> positions, normals;
        const std::vector<vec3> none(model.body.count(), vec3(0));
        deform(model.embedding, {model.body.positions, none}, positions, normals);
        ASSERT_EQ(positions.size(), model.surface.positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            EXPECT_LT(glm::distance(positions[i], model.surface.positions[i]), 1e-6f);
            EXPECT_LT(glm::distance(normals[i], model.surface.normals[i]), 1e-4f);
        }
    }
}

TEST(Build, WhatHoldsEverythingOrIsTooLargeIsANote) {
    EXPECT_TRUE(has_note(make(cube + "pin = { below = 1 }\n"), "cube: pin holds all its 216 nodes"));
    EXPECT_FALSE(has_note(make(cube + "pin = { below = 0.5 }\n"), "pin"));
    EXPECT_TRUE(
        has_note(make("[[body]]\nname = \"box\"\ndims = [6, 6, 6]\nspacing = 4\nstiffness = 5\nmass = 1\n"),
                 "box: it is 20 m long; is the unit right?"));
    EXPECT_TRUE(has_note(make("[[body]]\nname = \"rag\"\ncloth = [6, 6]\nspacing = 1e-4\nmass = 1e-6\n"),
                         "rag: it is 0.0005 m long; is the unit right?"));
}

TEST(Build, PathsInMillimetresAreANote) {
    const std::string path = "path = [[0, 0, 0, 0], [1, 0, 50, 0]]\n";
    EXPECT_TRUE(has_note(make(cube + "[[tool]]\nname = \"tip\"\n" + path),
                         "tool tip: its path (line 10) leads 50 m away"));
    EXPECT_TRUE(has_note(make(cube + "[[collider]]\nplane = {}\n" + path), "collider 1: its path (line 10)"));
    EXPECT_TRUE(
        has_note(make(cube + "[[move]]\nnodes = { below = 0 }\n" + path), "move 1: its path (line 10)"));
    EXPECT_TRUE(
        has_note(make(cube + "pin = { near = [0, 20, 0] }\n"), "pin.near is 20 m from the nearest node"));
    EXPECT_TRUE(make(cube + "pin = { near = [0, 0.03, 0] }\n").notes.empty());
    EXPECT_TRUE(make(cube + "[[tool]]\npath = [[0, 0, 0.05, 0], [1, 0, 0.03, 0]]\n").notes.empty());
}

TEST(Build, MissingFilesAreNamedWithTheirLineBeforeTheWork) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.05f), 12), scratch / "liver.ply");
    const std::string liver = "[[body]]\nname = \"a\"\nsurface = \"liver.ply\"\nstiffness = 5\nmass = 1\n";
    for (const auto& [more, words] : std::vector<std::array<std::string, 2>>{
             {"[[surface]]\nsurface = \"Liver.ply\"\n", "surface of surface surface1, Liver.ply"},
             {"[[surface]]\nvolume = \"liver.nii\"\n", "volume of surface surface1, liver.nii"},
             {"[[body.region]]\nlabels = \"liver.nrrd\"\nlabel = 1\nfactor = 2\n", "labels of body a"},
             {"[[collider]]\nfield = { surface = \"lver.ply\" }\n", "field.surface of collider 1"},
             {"[[tool]]\npath = \"lver.csv\"\n", "lver.csv"}}) {
        const std::string said = refusal(liver + more, scratch / ".");
        EXPECT_NE(said.find(words), std::string::npos) << more << said;
        EXPECT_NE(said.find("test.toml, line 7"), std::string::npos) << said;
        const bool near = said.find("iver.ply") != said.npos || said.find("lver.ply") != said.npos;
        EXPECT_EQ(near, said.find("did you mean liver.ply?") != said.npos) << said;
    }
}

TEST(Build, FilesOfAnotherKindAreNamedWithTheirLineAndWhatToWrite) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.05f), 12), scratch / "k.ply");
    for (const char* name : {"v.nii", "s.toml", "bad.ply", "bad.csv", "bad.png"})
        write_text(scratch / name, "x,y\n1\n");
    std::filesystem::create_directory(scratch / "slices");
    const std::string of = "[[body]]\nname = \"a\"\nstiffness = 5\nmass = 1\n";
    const std::string liver = of + "surface = \"k.ply\"\n";
    for (const auto& [text, line, words] : std::vector<std::array<std::string, 3>>{
             {of + "surface = \"v.nii\"\n", "5", "which is a volume, in"},
             {of + "surface = \"v.nii\"\n", "5", "write volume = \"v.nii\""},
             {of + "volume = \"k.ply\"\n", "5", "write surface = \"k.ply\""},
             {of + "surface = \"s.toml\"\n", "5", "which is a scene"},
             {of + "surface = \"slices\"\n", "5", "which is a folder"},
             {of + "surface = \"bad.ply\"\n", "5", "surface of body a: "},
             {of + "volume = \"v.nii\"\n", "5", "volume of body a: "},
             {liver + "[[body.region]]\nlabels = \"k.ply\"\nlabel = 1\nfactor = 2\n", "7", "name a volume"},
             {liver + "[[collider]]\npolygon = { surface = \"s.toml\" }\n", "7",
              "polygon.surface of collider 1 is s.toml"},
             {liver + "[[collider]]\nfield = { surface = \"bad.ply\" }\n", "7",
              "field.surface of collider 1: "},
             {liver + "[[tool]]\npath = \"bad.csv\"\n", "7", "path: "},
             {liver + "pin = { nodes = [1000000] }\n", "6", "pin.nodes names node 1000000"},
             {liver + "weld = 1\n", "5", "weld is 1 m, and the whole surface is 0.1 m long"}}) {
        const std::string said = refusal(text, scratch / ".");
        EXPECT_NE(said.find(words), std::string::npos) << words << " in: " << said;
        EXPECT_NE(said.find("test.toml, line " + line), std::string::npos) << said;
    }
    const Models coarse = make(liver + "spacing = 1\n", scratch / ".");
    EXPECT_TRUE(has_note(coarse, "spacing is 1 m and the body 0.1 m long"));
    EXPECT_FALSE(has_note(coarse, "more nodes"));
}

// The grid of a field is as fine as its walls need and memory allows; where it is not, that is said, with a
// spacing that sees them.
TEST(Build, TheWallsOfAFieldDecideItsSpacing) {
    Scratch scratch;
    auto with = [&](const Mesh& mesh, const std::string& more = "") {
        write_mesh(mesh, scratch / "obstacle.obj");
        return make(cube + "[[collider]]\nfield = { surface = \"obstacle.obj\"" + more + " }\n",
                    scratch / ".");
    };
    auto field = [](const Models& made) -> const DistanceField& {
        return std::get<DistanceField>(made.simulation.colliders[0].shape);
    };
    auto plate = [](float thickness) { return block(vec3(-1, -thickness, -1), vec3(1, 0, 1)); };
    Mesh turned_round = plate(0.03f);
    for (uvec3& t : turned_round.triangles) std::swap(t.x, t.y);
    for (const Mesh& table : {plate(0.03f), turned_round}) {
        const Models made = with(table);
        EXPECT_TRUE(made.notes.empty());
        EXPECT_LE(std::abs(field(made).spacing / 0.0075f - 1), 0.01f);
        const Models coarse = with(table, ", spacing = 0.02");
        EXPECT_EQ(field(coarse).spacing, 0.02f);
        EXPECT_TRUE(has_note(coarse, "collider 1: 9"));  // more than 90 % of it
        EXPECT_TRUE(has_note(coarse, "down to 0.03 m"));
        EXPECT_TRUE(has_note(coarse, "use spacing = 0.0075"));
        EXPECT_TRUE(with(table, ", spacing = 0.0125").notes.empty());
    }
    // A foil would take ten thousand million points.
    const Models foil = with(plate(0.0005f));
    EXPECT_EQ(field(foil).spacing, 2.0f / 64);
    EXPECT_TRUE(
        has_note(foil, "thinner than twice the 0.0312 m between the points of its field, down to 0.0005 m"));
    EXPECT_TRUE(has_note(foil, "use a box, a polygon or thicker walls"));

    // Edges, tips and what is thick have the usual spacing.
    const Mesh wedge{
        {{0, 0, 0}, {1, 0, 0}, {1, 0.4f, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0.4f, 1}},
        {},
        {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {0, 5, 2}, {0, 3, 5}}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> radius(0.02f, 0.1f);
    EXPECT_TRUE(with(plate(0.2f)).notes.empty());
    EXPECT_TRUE(with(ellipsoid({0.05f, 0.04f, 0.03f}, 24)).notes.empty());
    for (const Mesh& thick :
         {plate(0.2f), wedge, ellipsoid({radius(random), radius(random), radius(random)}, 24),
          ellipsoid({radius(random), radius(random), radius(random)}, 24)}) {
        const Models made = with(thick);
        const vec3 size = bounds(thick).size();
        EXPECT_LE(std::abs(field(made).spacing / (std::max({size.x, size.y, size.z}) / 64) - 1), 1e-5f);
    }
}

TEST(Build, SpringsOfThreeKindsMakeTheVolumeOf2012) {
    const Body body = make(R"(
[[body]]
dims = [3, 3, 3]
spacing = 0.01
springs = { structural = 7, shear = 5, flexion = 3 }
mass = 0.1
link_damping = 0.002
)")
                          .models[0]
                          .body;
    EXPECT_EQ(body.grid()->links.size(), 32u);
    EXPECT_EQ(body.link_damping, 0.002f);
    EXPECT_NEAR(mass(body), 0.1, 1e-6);
}

TEST(Build, ClothOfOneRowIsANote) {
    const Models made = make("[[body]]\nname = \"rope\"\ncloth = [1, 9]\nspacing = 0.01\nmass = 0.01\n");
    EXPECT_TRUE(made.models[0].surface.triangles.empty());
    EXPECT_TRUE(has_note(made, "rope: one node wide"));
    const Models thread = make("[[body]]\ndims = [1, 1, 9]\nspacing = 0.01\nmass = 0.01\nstiffness = 10\n");
    EXPECT_TRUE(has_note(thread, "one node thick"));
}

TEST(Build, ClothIsPlacedAndWeighed) {
    const Model flag = make(R"(
[[body]]
cloth = [5, 4]
spacing = 0.1
rotate = [90, 0, 0]
move = [0, 0, 1]
springs = { structural = 100, shear = 50, flexion = 5 }
density = 0.2
)")
                           .models[0];
    EXPECT_NEAR(mass(flag.body), 0.2 * 0.4 * 0.3, 1e-6);
    EXPECT_LT(glm::distance(flag.body.positions.back(), vec3(0.4f, 0, 1.3f)), 1e-6f);
    EXPECT_EQ(flag.surface.triangles.size(), 2u * 4 * 3);
    std::vector<vec3> positions, normals;
    const std::vector<vec3> up(flag.body.count(), vec3(0, -1, 0));
    deform(flag.embedding, {flag.body.positions, up}, positions, normals);
    ASSERT_EQ(positions.size(), flag.body.count());
    for (std::size_t i = 0; i < positions.size(); ++i)
        EXPECT_LT(glm::distance(positions[i], flag.surface.positions[i]), 1e-6f);
    for (std::size_t i = 0; i < flag.body.count(); ++i) {
        EXPECT_EQ(flag.surface.positions[i], flag.body.positions[i]);
        EXPECT_LT(glm::distance(flag.surface.normals[i], vec3(0, -1, 0)), 1e-6f);
    }
}

TEST(Build, ASheetIsItsOwnSurfaceAndMayBeOpen) {
    Scratch scratch;
    Mesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    compute_normals(square);
    write_mesh(square, scratch / "square.ply");
    const std::string text = "[[body]]\nsurface = \"square.ply\"\nsheet = true\ndensity = 0.5\n";
    const Models made = make(text, scratch / ".");
    ASSERT_EQ(made.notes.size(), 1u);
    EXPECT_EQ(made.notes[0], "body body1: smaller parts dropped: 1 (33 % of the area)");
    EXPECT_FALSE(made.models[0].steps.empty());
    const Model& sheet = made.models[0];
    EXPECT_EQ(sheet.body.count(), 4u);  // the largest part
    EXPECT_EQ(sheet.body.faces.size(), 2u);
    EXPECT_NEAR(mass(sheet.body), 0.5, 1e-6);
    EXPECT_EQ(make(text + "largest = false\n", scratch / ".").models[0].body.count(), 7u);

    EXPECT_EQ(spring_ends(sheet.body).size(), 6u);  // five edges and a flexion spring,
    const Body stiff = make(text + "bending = 1e-3\n", scratch / ".").models[0].body;
    EXPECT_EQ(spring_ends(stiff).size(), 5u);  // or a hinge
    ASSERT_EQ(std::get<Bending>(stiff.terms.at(1)).hinges.size(), 1u);
    EXPECT_FLOAT_EQ(std::get<Bending>(stiff.terms[1]).hinges[0].stiffness, 2e-3f);
}

TEST(Build, APictureCoversARectangleOfCloth) {
    const Models made = make(R"(
[[body]]
cloth = [5, 4]
spacing = 0.1
rotate = [90, 0, 0]
move = [0, 0, 1]
density = 0.2
weave = [8, 6]
)");
    const Mesh& flag = made.models[0].surface;
    ASSERT_EQ(flag.uvs.size(), 20u);
    ASSERT_EQ(flag.tangents.size(), 20u);
    for (std::size_t i = 0; i < 20; ++i) {
        const vec3 p = flag.positions[i];  // turned flat: v runs along z
        EXPECT_LT(glm::distance(flag.uvs[i], vec2(p.x / 0.4f, (p.z - 1) / 0.3f)), 1e-5f);
        EXPECT_LT(glm::distance(flag.tangents[i], vec4(1, 0, 0, 1)), 1e-5f);
    }
    EXPECT_EQ(made.models[0].normal_map.width, 8 * 16);
    EXPECT_EQ(made.models[0].normal_map.height, 6 * 16);
    EXPECT_TRUE(made.models[0].colour_map.empty());
    // The cloth is the same without it.
    const Model plain =
        make(
            "[[body]]\ncloth = [5, 4]\nspacing = 0.1\nrotate = [90, 0, 0]\nmove = [0, 0, 1]\ndensity = 0.2\n")
            .models[0];
    EXPECT_EQ(plain.surface.positions, flag.positions);
    EXPECT_TRUE(plain.surface.tangents.empty());
}

TEST(Build, MapsHangOnTheNodesOfTheMendedSolid) {
    Scratch scratch;
    write_text(scratch / "cube.obj", textured_cube());
    const Image red{2, 1, {255, 0, 0, 255, 0, 255, 0, 255}}, flat{1, 1, {128, 128, 255, 255}};
    write_png(red, scratch / "red.png");
    write_png(flat, scratch / "flat.png");
    const std::string text =
        "[[body]]\nsurface = \"cube.obj\"\nyoungs_modulus = 5000\ndensity = 1000\nnodes = 500\n"
        "rotate = [0, 0, 90]\n";
    const Model plain = make(text, scratch / ".").models[0];
    const Model worn =
        make(text + "colour_map = \"red.png\"\nnormal_map = \"flat.png\"\n", scratch / ".").models[0];
    EXPECT_EQ(worn.body.positions, plain.body.positions);
    EXPECT_EQ(plain.surface.positions.size(), 8u);
    EXPECT_TRUE(plain.colour_map.empty() && plain.normal_map.empty() && plain.surface.tangents.empty());
    EXPECT_EQ(worn.colour_map.pixels, red.pixels);
    EXPECT_EQ(worn.normal_map.pixels, flat.pixels);
    ASSERT_EQ(worn.surface.positions.size(), 24u);
    ASSERT_EQ(worn.surface.tangents.size(), 24u);
    ASSERT_EQ(worn.embedding.tangents.size(), 24u);
    // The nodes turned by 90° about x take positions, normals and tangents along.
    std::vector<vec3> turned, positions, normals;
    std::vector<vec4> tangents;
    const mat3 by = turn({90, 0, 0});
    for (vec3 p : worn.body.positions) turned.push_back(by * p);
    const std::vector<vec3> none(worn.body.count(), vec3(0));
    deform(worn.embedding, {turned, none}, positions, normals, &tangents);
    ASSERT_EQ(tangents.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i) {
        EXPECT_LT(glm::distance(positions[i], by * worn.surface.positions[i]), 1e-5f);
        EXPECT_LT(glm::distance(normals[i], by * worn.surface.normals[i]), 1e-4f);
        EXPECT_LT(glm::distance(vec3(tangents[i]), by * vec3(worn.surface.tangents[i])), 1e-4f);
        EXPECT_EQ(tangents[i].w, worn.surface.tangents[i].w);
        EXPECT_LT(std::abs(glm::dot(vec3(tangents[i]), normals[i])), 1e-4f);
    }
    // Vertices in one place stay in one place, to the bit: no seam opens.
    const auto first = first_in_place(worn.surface.positions);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(positions[i], positions[first[i]]);
    EXPECT_THROW(make(text + "colour_map = \"none.png\"\n", scratch / "."), Error);
    write_text(scratch / "red.png", "no picture");
    EXPECT_THROW(make(text + "colour_map = \"red.png\"\n", scratch / "."), Error);
}

std::vector<int> strengthened(const Body& body, float factor) {
    std::vector<int> nodes;
    for (std::size_t i = 0; i < body.grid()->strength.size(); ++i)
        if (std::abs(body.grid()->strength[i] / factor - 1) < 1e-5f) nodes.push_back(int(i));
    return nodes;
}

TEST(Build, RegionsSayHowStiffTheyAreInThreeWays) {
    const std::string where = "[[body.region]]\nbox = [[-1, -1, -1], [0.001, 1, 1]]\n";
    const std::string of_springs = cube + "model = \"springs\"\n" + where;
    const auto by_factor = strengthened(make(of_springs + "factor = 3\n").models[0].body, 3);
    EXPECT_EQ(by_factor.size(), 36u);
    EXPECT_EQ(strengthened(make(of_springs + "youngs_modulus = 15000\n").models[0].body, 3), by_factor);
    EXPECT_EQ(strengthened(make(of_springs + "stiffness = 24\n").models[0].body, 3), by_factor);
    EXPECT_EQ(strengthened(make(cube + where + "youngs_modulus = 15000\n").models[0].body, 3), by_factor);
    EXPECT_THROW(make(cube + where + "stiffness = 24\n"), Error);
    // Of two, the last counts.
    const Body both =
        make(cube + where + "factor = 3\n[[body.region]]\nnodes = [0, 1]\nfactor = 5\n").models[0].body;
    EXPECT_EQ(strengthened(both, 5), (std::vector<int>{0, 1}));
    EXPECT_EQ(strengthened(both, 3).size(), 35u);
    const Models none = make(cube + "[[body.region]]\nbox = [[8, 8, 8], [9, 9, 9]]\nfactor = 3\n");
    EXPECT_TRUE(has_note(none, "cube, region 1: box selects no node"));
    EXPECT_TRUE(strengthened(none.models[0].body, 3).empty());
}

// With no modulus it gets one at which its own weight strains it by three hundredths, however large it is.
TEST(Build, ABodyWithoutAModulusBearsItsWeight) {
    auto modulus = [](const std::string& more, float spacing) {
        const Models made =
            make(fmt::format("[[body]]\nname = \"cube\"\ndims = [3, 11, 3]\ndensity = 1000\n"
                             "spacing = {}\npin = {{ below = 0 }}\n{}",
                             spacing, more));
        EXPECT_TRUE(has_note(made, "cube: it is given youngs_modulus = "));
        return tissue_of(made.models[0].body)->youngs_modulus;
    };
    for (float h : {0.001f, 0.013f, 0.4f}) {
        const float expected = 1000 * 9.81f * 9.5f * h / 0.03f;
        EXPECT_LE(std::abs(modulus("", h) / expected - 1), 0.05f);
        EXPECT_EQ(modulus("[simulation]\ngravity = [0, -2, 0]\n", h), modulus("", h));
        const float lying = modulus("[simulation]\ngravity = [-9, 0, 0]\n", h);  // two of ten layers high
        EXPECT_LT(lying, 0.3f * modulus("", h));
    }
    // So small that steps would be too short: 40 E = ρ (1.16 · 30,000 h)².
    const float tiny = 1e-5f, allowed = 1000 * std::pow(1.16f * 30'000 * tiny, 2.0f) / 40;
    EXPECT_LE(std::abs(modulus("", tiny) / allowed - 1), 0.05f);
    const Body hard = make(
                          "[[body]]\ndims = [3, 5, 3]\nspacing = 0.01\ndensity = 1000\n[[body.region]]\n"
                          "box = [[-1, -1, -1], [1, 0.001, 1]]\nyoungs_modulus = 5000\n")
                          .models[0]
                          .body;
    EXPECT_FALSE(std::ranges::all_of(tissue_of(hard)->weights, [](float weight) { return weight == 1; }));
}

// A NIfTI file of 3 x 3 x 3 voxels of 10 mm whose axes are the world's, the first of them at the origin.
void write_labels(const std::filesystem::path& path, const std::vector<float>& values) {
    std::string bytes(352, '\0');
    auto set = [&](std::size_t at, auto value) { std::memcpy(&bytes[at], &value, sizeof value); };
    set(0, std::int32_t(348));
    for (std::size_t i = 0; i < 8; ++i) set(40 + 2 * i, std::int16_t(i == 0 || i > 3 ? (i == 0 ? 3 : 1) : 3));
    set(70, std::int16_t(16));  // float
    set(72, std::int16_t(32));
    for (std::size_t i = 0; i < 4; ++i) set(76 + 4 * i, i == 0 ? 1.0f : 10.0f);
    set(108, 352.0f);
    bytes[123] = 2;             // millimetres
    set(254, std::int16_t(1));  // the matrix below counts; NIfTI's x and y point the other way
    for (std::size_t i = 0; i < 3; ++i) set(280 + 20 * i, i < 2 ? -10.0f : 10.0f);
    bytes.replace(344, 3, "n+1");
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST(Build, LabelsTurnAndMoveWithTheBody) {
    Scratch scratch;
    std::vector<float> values(27, 0);
    values[13] = 7;  // the voxel in the middle, from 5 to 15 mm
    write_labels(scratch / "labels.nii", values);
    const std::string region = "[[body.region]]\nlabels = \"labels.nii\"\nlabel = 7\nfactor = 2\n";
    for (const char* placed : {"", "rotate = [0, 0, 90]\nmove = [1, 2, 3]\n"}) {
        const Body body = make(cube + placed + region, scratch / ".").models[0].body;
        const auto nodes = strengthened(body, 2);
        EXPECT_EQ(nodes.size(), 8u);
        for (int node : nodes)
            for (int axis = 0; axis < 3; ++axis) {
                const int at = body.at[std::size_t(node)][axis];
                EXPECT_TRUE(at == 2 || at == 3) << at;
            }
    }
    values[0] = std::nanf("");
    write_labels(scratch / "labels.nii", values);
    EXPECT_TRUE(has_note(make(cube + region, scratch / "."), "cube, region 1, labels: 1 voxels"));
    EXPECT_TRUE(has_note(
        make(cube + "[[body.region]]\nlabels = \"labels.nii\"\nlabel = 9\nfactor = 2\n", scratch / "."),
        "label selects no node"));
    EXPECT_THROW(make(cube + "[[body.region]]\nlabels = \"none.nii\"\nlabel = 9\nfactor = 2\n"), Error);
}

TEST(Build, MovedNodesArePinnedAndTurnAboutTheirMiddle) {
    const std::string move = "[[move]]\npath = [[0, 0, 0, 0]]\nnodes = ";
    const Models made = make(cube + move + "{ box = [[-1, -1, -1], [0.001, 1, 1]], nodes = [0] }\n");
    ASSERT_EQ(made.moves.size(), 1u);
    EXPECT_EQ(made.moves[0].nodes.size(), 36u);  // node 0 once
    EXPECT_LT(glm::distance(made.moves[0].about, vec3(0, 0.01f, 0.01f)), 1e-6f);
    for (int node : made.moves[0].nodes) EXPECT_EQ(made.models[0].body.inverse_mass[std::size_t(node)], 0);
    EXPECT_TRUE(has_note(make(cube + move + "{ box = [[8, 8, 8], [9, 9, 9]] }\n"), "move 1: nodes.box"));
    EXPECT_THROW(make(cube + move + "{ nodes = [216] }\n"), Error);
}

TEST(Build, CollidersThatMoveAreGivenAboutTheirPivot) {
    const std::string path = "path = [[0, 0, 0, 0]]\n";
    const Models made = make(cube + "[[collider]]\nsphere = { centre = [1, 2, 3] }\n" +
                             "[[collider]]\nsphere = { centre = [1, 2, 3] }\n" + path +
                             "[[collider]]\nsphere = { centre = [1, 2, 3] }\nabout = [1, 1, 1]\n" + path +
                             "[[collider]]\nplane = { offset = 2 }\n" + path);
    const auto& all = made.simulation.colliders;
    ASSERT_EQ(all.size(), 4u);
    EXPECT_EQ(std::get<Sphere>(all[0].shape).centre, vec3(1, 2, 3));
    EXPECT_EQ(made.pivots[0], vec3(0));
    EXPECT_EQ(std::get<Sphere>(all[1].shape).centre, vec3(0));
    EXPECT_EQ(made.pivots[1], vec3(1, 2, 3));
    EXPECT_EQ(std::get<Sphere>(all[2].shape).centre, vec3(0, 1, 2));
    EXPECT_EQ(std::get<Plane>(all[3].shape).offset, 0);
    EXPECT_EQ(made.pivots[3], vec3(0, 2, 0));
}

TEST(Build, WhatAColliderLeavesOutOfItsFileIsSaid) {
    const Scratch scratch;
    write_text(scratch / "plate.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n");
    EXPECT_TRUE(has_note(make(cube + "[[collider]]\npolygon = { surface = \"plate.obj\" }\n", scratch / "."),
                         "collider 1: left out a point or a line"));
}

TEST(Build, CollidersFromFiles) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(50), 20), scratch / "ball.ply");  // millimetres
    const std::string file = "surface = \"ball.ply\", units = \"mm\", move = [1, 0, 0]";
    const Models made = make(cube + "[[collider]]\nfield = { " + file + " }\n[[collider]]\npolygon = { " +
                                 file + ", thickness = 0.003 }\n",
                             scratch / ".");
    const auto& field = std::get<DistanceField>(made.simulation.colliders[0].shape);
    EXPECT_NEAR(field.at({1, 0.052f, 0}), 0.002f, 0.0005f);
    EXPECT_NEAR(field.at({1.048f, 0, 0}), -0.002f, 0.0005f);
    const auto& polygon = std::get<Polygon>(made.simulation.colliders[1].shape);
    EXPECT_EQ(polygon.thickness, 0.003f);
    EXPECT_EQ(polygon.triangles.size(), 20u * 2 * 20 * 2 - 80);
    for (const auto& corners : polygon.triangles)
        EXPECT_NEAR(glm::distance(corners[0], vec3(1, 0, 0)), 0.05f, 1e-5f);
    EXPECT_THROW(make(cube + "[[collider]]\nfield = { surface = \"none.ply\" }\n"), Error);
    EXPECT_THROW(make(cube + "[[collider]]\nfield = { spacing = 1e-6, " + file + " }\n", scratch / "."),
                 Error);
}

// ---- what is made again ----

// Where a surface is when its nodes have moved somehow: the same for embeddings that are the same.
std::vector<vec3> carried(const Model& model) {
    std::vector<vec3> places = model.body.positions, arrows(places.size()), positions, normals;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] += 0.01f * vec3(std::sin(300 * places[i].y), std::sin(200 * places[i].z), 0);
        arrows[i] = vec3(std::sin(float(i)), 1, std::cos(float(i)));
    }
    deform(model.embedding, {places, arrows}, positions, normals);
    positions.insert(positions.end(), normals.begin(), normals.end());
    return positions;
}

void expect_same(const Models& a, const Models& b, const std::string& after) {
    ASSERT_EQ(a.models.size(), b.models.size());
    for (std::size_t m = 0; m < a.models.size(); ++m) {
        const Body &one = a.models[m].body, &other = b.models[m].body;
        EXPECT_EQ(one.positions, other.positions) << after;
        EXPECT_EQ(one.inverse_mass, other.inverse_mass) << after;
        EXPECT_TRUE(one.terms == other.terms) << after;
        EXPECT_EQ(one.area, other.area) << after;
        EXPECT_EQ(one.cover, other.cover) << after;
        EXPECT_EQ(one.damping, other.damping) << after;
        EXPECT_EQ(one.link_damping, other.link_damping) << after;
        EXPECT_EQ(a.models[m].surface.positions, b.models[m].surface.positions) << after;
        EXPECT_EQ(carried(a.models[m]), carried(b.models[m])) << after;
    }
    EXPECT_EQ(a.pivots, b.pivots) << after;
    ASSERT_EQ(a.static_surfaces.size(), b.static_surfaces.size());
}

TEST(Rebuild, IsTheSameToTheBitAsBuilding) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.05f, 0.03f, 0.04f), 16), scratch / "ball.ply");
    const std::string text = R"([[body]]
name = "ball"
surface = "ball.ply"
nodes = 700
youngs_modulus = 5000
density = 1000
pin = { below = 0.2 }
[[body.region]]
near = [0.03, 0, 0]
radius = 0.02
factor = 3
[[body]]
name = "box"
dims = [5, 4, 3]
spacing = 0.01
stiffness = 20
mass = 0.1
[[surface]]
name = "still"
surface = "ball.ply"
[[move]]
body = "ball"
nodes = { near = [0, 0.03, 0] }
path = [[0, 0, 0, 0], [1, 0, 0.01, 0]]
)";
    std::vector<Change> changes;
    Scene before = parse_scene(text, "test.toml", scratch / ".");
    Models made = build(before);
    for (const char* change :
         {"body.ball.youngs_modulus=9000", "body.ball.density=1100", "body.ball.pin={nodes=[3,4,5]}",
          "body.ball.pin={below=0.3}", "simulation.gravity=[5,0,0]", "body.ball.mapping=\"frames\"",
          "body.ball.damping=3", "body.ball.links=\"equal\"", "body.ball.mapping=\"constant\"",
          "body.ball.links=\"cells\"", "body.ball.nodes=900", "body.ball.colour=[1,0,0]",
          "body.ball.size=0.08", "body.box.stiffness=30", "body.box.dims=[4,4,4]", "surface.still.size=0.1",
          "move.1.nodes={near=[0,-0.03,0]}", "simulation.integrator=\"rk4\""}) {
        changes.push_back(change);
        const Scene scene = parse_scene(text, "test.toml", scratch / ".", changes);
        Models again = rebuild(scene, before, made);
        expect_same(again, build(scene), change);
        before = scene;
        made = std::move(again);
    }
}

TEST(Rebuild, ReadsNoFileForAnotherStiffness) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.05f), 12), scratch / "ball.ply");
    const std::string text =
        "[[body]]\nname = \"ball\"\nsurface = \"ball.ply\"\nnodes = 300\nyoungs_modulus = 5000\ndensity = "
        "1000\n";
    const Scene before = parse_scene(text, "test.toml", scratch / ".");
    const Models made = build(before);
    std::filesystem::remove(scratch / "ball.ply");
    auto changed = [&](const Change& change) {
        const Change changes[] = {change};
        return rebuild(parse_scene(text, "test.toml", scratch / ".", changes), before, made);
    };
    for (const char* change :
         {"body.ball.youngs_modulus=7000", "body.ball.nodes=400", "body.ball.mapping=\"frames\""})
        EXPECT_NO_THROW(changed(change)) << change;
    EXPECT_THROW(changed("body.ball.size=0.2"), Error);
}

TEST(Changed, IsTomlThatReadsAsTheSameScene) {
    const SceneText scene{cube + "# a word\n[camera]\neye = [1, 2, 3]\n", "test.toml", "."};
    const std::vector<Change> changes = {"body.cube.damping=4", "body.1.pin={nodes=[1,2]}",
                                         "simulation.integrator=\"rk4\"", "simulation.gravity=[0.1,0.2,0.3]"};
    const Scene saved = parse_scene(changed(scene, changes), "test.toml", ".");
    const Scene said = parse_scene(scene, changes);
    ASSERT_EQ(saved.bodies.size(), 1u);
    EXPECT_TRUE(saved.bodies[0] == said.bodies[0]);
    EXPECT_EQ(saved.camera.eye, said.camera.eye);
    EXPECT_EQ(saved.simulation.integrator, said.simulation.integrator);
    EXPECT_EQ(saved.simulation.gravity, said.simulation.gravity);
    EXPECT_THROW(changed(scene, std::vector<Change>{"nonsense"}), Error);
}

}  // namespace
}  // namespace palpate
