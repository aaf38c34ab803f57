// What a glTF file shows: where its vertices are at rest, which of its nodes count, and what it may require.
#include "palpate/base/files.h"
#include "tests/files/gltf_making.h"
#include "tests/scratch.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <random>

namespace palpate {
namespace {

// ---- what moves vertices at rest ----

TEST(Gltf, ASkinPlacesItsVerticesAndTheNodeDoesNot) {
    for (float node_scale : {1.f, 7.f, -7.f}) {
        Making file = a_brick(100);
        file.primitive()["attributes"]["JOINTS_0"] =
            file.accessor(std::vector<std::uint8_t>(32, 0), uint8, "VEC4");
        std::vector<float> weights;
        for (int i = 0; i < 8; ++i) weights.insert(weights.end(), {1, 0, 0, 0});
        file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor(weights, float32, "VEC4");
        file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"scale", {node_scale, node_scale, node_scale}}},
                              {{"children", {2}}, {"scale", {0.01, 0.01, 0.01}}},
                              {{"name", "joint"}}};
        file.json["scenes"][0]["nodes"] = {0, 1};
        file.json["skins"] = {{{"joints", {2}}}};
        expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
        // The same, with a matrix that undoes where the joint is at rest.
        file.json["skins"][0]["inverseBindMatrices"] = file.accessor(
            std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -100, 0, 0, 1}, float32, "MAT4");
        expect_box(file.read(), vec3(-1, 0, 0), vec3(1, 3, 5), 30);
    }
}

TEST(Gltf, VerticesGoByAllTheirJointsByWeight) {
    std::mt19937 random(1);
    const auto number = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
    const auto vector = [&] { return dvec3(number(), number(), number()); };
    Making file = a_brick();
    std::vector<glm::dmat4> joints, inverse;
    Json nodes = {{{"mesh", 0}, {"skin", 0}, {"translation", {9, 9, 9}}}}, list;
    std::vector<float> matrices;
    for (int k = 0; k < 5; ++k) {  // each joint hangs on the one before
        const dvec3 move = vector(), axis = glm::normalize(vector());
        const double angle = number();
        const glm::dquat turn = glm::angleAxis(angle, axis);
        const glm::dmat4 own = glm::translate(glm::dmat4(1), move) * glm::mat4_cast(turn);
        joints.push_back(k == 0 ? own : joints.back() * own);
        inverse.push_back(glm::inverse(glm::translate(glm::dmat4(1), vector())));
        nodes.push_back({{"translation", {move.x, move.y, move.z}},
                         {"rotation", {3 * turn.x, 3 * turn.y, 3 * turn.z, 3 * turn.w}}});  // not of length 1
        if (k < 4) nodes.back()["children"] = {k + 2};
        list.push_back(k + 1);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) matrices.push_back(float(inverse.back()[c][r]));
    }
    file.json["nodes"] = nodes;
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["skins"] = {
        {{"joints", list}, {"inverseBindMatrices", file.accessor(matrices, float32, "MAT4")}}};
    std::vector<std::uint16_t> on[2];
    std::vector<std::uint16_t> by[2];  // normalised, and of any sum
    for (int set = 0; set < 2; ++set) {
        for (int i = 0; i < 32; ++i) on[set].push_back(std::uint16_t(random() % 5));
        for (int i = 0; i < 32; ++i) by[set].push_back(std::uint16_t(random() % 30000));
        file.primitive()["attributes"][fmt::format("JOINTS_{}", set)] =
            file.accessor(on[set], uint16, "VEC4");
        file.primitive()["attributes"][fmt::format("WEIGHTS_{}", set)] =
            file.accessor(by[set], uint16, "VEC4", true);
    }
    const Mesh mesh = file.read();
    ASSERT_EQ(mesh.positions.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        glm::dvec4 sum(0);
        for (int set = 0; set < 2; ++set)
            for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
                sum += double(by[set][k]) *
                       (joints[on[set][k]] * inverse[on[set][k]] * glm::dvec4(dvec3(brick.positions[i]), 1));
        EXPECT_LE(glm::distance(dvec3(mesh.positions[i]), dvec3(sum) / sum.w), 1e-5) << i;
    }
}

TEST(Gltf, MorphTargetsCountByTheirDefaultWeights) {
    Making file = a_brick();
    std::vector<vec3> up;
    for (vec3 p : brick.positions) up.push_back(vec3(0, 0, p.z > 0 ? 3 : 0));
    file.primitive()["targets"] = {{{"POSITION", file.vectors(up)}}, {{"POSITION", file.vectors(up)}}};
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    file.json["meshes"][0]["weights"] = {1.0, 0.0};
    expect_box(file.read(), vec3(0), vec3(2, 3, 8), 48);
    file.node()["weights"] = {0.5, -0.25};  // which count instead
    expect_box(file.read(), vec3(0), vec3(2, 3, 5.75f), 34.5);
    file.node()["weights"] = {0, 0};
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    file.json["accessors"].back()["count"] = 7;
    file.node()["weights"] = {0, 1};
    EXPECT_HAS(file.refused(), "morph target with another number");
}

TEST(Gltf, InstancesStandWhereTheirListsSay) {
    Making file = a_brick();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    Json& places = file.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    places["TRANSLATION"] = file.vectors({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}});
    const Mesh mesh = file.read();
    expect_box(mesh, vec3(0), vec3(22, 3, 5), 90);
    EXPECT_EQ(mesh.triangles.size(), 36u);
    // By 180 degrees about y, as normalised shorts; mirrored; and the node's own place outside of that.
    const std::int16_t one = 32767;
    places["ROTATION"] = file.accessor(std::vector<std::int16_t>{0, 0, 0, one, 0, one, 0, 0, 0, 0, 0, one},
                                       int16, "VEC4", true);
    places["SCALE"] = file.vectors({{1, 1, 1}, {1, 2, 1}, {1, 1, -1}});
    file.node()["translation"] = {0, 100, 0};
    expect_box(file.read(), vec3(0, 100, -5), vec3(22, 106, 5), 30 + 60 + 30);
    places["SCALE"] = file.vectors({{1, 1, 1}});
    EXPECT_HAS(file.refused(), "differ in number");
}

// As normals serve the positions, which are units along the axes: mirrored ones point back through it.
TEST(Gltf, NodesMoveTurnAndMirrorWhatHangsOnThem) {
    Making file;
    const int corners = file.vectors({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    file.primitive()["attributes"] = {{"POSITION", corners}, {"NORMAL", corners}};
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "translation": [1, 2, 3], "children": [1]},
        {"mesh": 0, "scale": [2, -1, 4]}, {"mesh": 0, "rotation": [0, 0, 0.70710678, 0.70710678]}])");
    file.json["scenes"][0]["nodes"] = {0, 2};
    const Mesh mesh = parse_mesh(file.glb(), "a.glb", Units::centimetres);
    const std::vector<vec3> places = {{2, 2, 3}, {1, 3, 3}, {1, 2, 4},  {3, 2, 3}, {1, 1, 3},
                                      {1, 2, 7}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    const std::vector<vec3> normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},  {1, 0, 0}, {0, -1, 0},
                                       {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    ASSERT_EQ(mesh.positions.size(), 9u);
    ASSERT_EQ(mesh.normals.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_LE(glm::length(mesh.positions[i] - 0.01f * places[i]), 1e-8f) << i;
        EXPECT_LE(glm::length(mesh.normals[i] - normals[i]), 1e-6f) << i;
    }
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {5, 4, 3}, {6, 7, 8}}));
    file.node()["scale"] = {1e38, 1e38, 1e38};
    file.json["nodes"][1]["scale"] = {1e38, 1e38, 1e38};
    EXPECT_HAS(file.refused(), "not finite");
}

TEST(Gltf, MirroredNodesTurnTheirFacesOver) {
    Making file = a_brick();
    file.node()["scale"] = {-1, 2, 1};
    expect_box(file.read(), vec3(-2, 0, 0), vec3(0, 6, 5), 60);
    file.node() = {{"mesh", 0}, {"matrix", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1}}};
    expect_box(file.read(), vec3(7, 0, 0), vec3(10, 2, 5), 30);
}

// ---- what a file may require ----

TEST(Gltf, WhatItRequiresIsKnownOrRefusedByName) {
    Making file = a_brick();
    for (const char* harmless : {"KHR_materials_unlit", "KHR_texture_basisu", "EXT_texture_webp"}) {
        file.json["extensionsRequired"] = {harmless};
        expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    }
    file.json["extensionsRequired"] = {"KHR_materials_unlit", "ACME_bent_space"};
    EXPECT_HAS(file.refused(), "\"ACME_bent_space\", which is not read");
    Making next = a_brick();
    next.json["asset"]["version"] = "3.0";
    EXPECT_HAS(next.refused(), "version \"3.0\"");
}

// ---- the scene ----

TEST(Gltf, TheSceneThatTheFileShows) {
    Making file = a_brick();
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {10, 0, 0}}}};
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);  // of which the second is no part
    file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.json["scene"] = 1;
    std::vector<std::string> notes;
    expect_box(file.read(&notes), vec3(10, 0, 0), vec3(12, 3, 5), 30);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 1 scene ");
    file.json.erase("scene");
    file.json.erase("scenes");
    expect_box(file.read(), vec3(0), vec3(12, 3, 5), 60);
    file.json.erase("nodes");
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
}

TEST(Gltf, NodesThatAreNotVisibleAreLeftOut) {
    Making file = a_brick();
    file.json["extensionsRequired"] = {"KHR_node_visibility"};
    file.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"mesh", 0}, {"translation", {10, 0, 0}}}};
    file.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    std::vector<std::string> notes;
    expect_box(file.read(&notes), vec3(0), vec3(2, 3, 5), 30);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 1 invisible node");
}

TEST(Gltf, ASceneWithoutAMeshGivesWayToOneThatHasSome) {
    Making file = a_brick();
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json.erase("scene");
    file.json["scenes"] = {{{"name", "nothing"}}, {{"nodes", {0}}}};
    std::vector<std::string> notes;
    expect_box(file.read(&notes), vec3(0), vec3(2, 3, 5), 30);
    ASSERT_FALSE(notes.empty());
    EXPECT_HAS(notes[0], "read scene 1, counted from 0");
    file.json["scenes"] = {{{"name", "nothing"}}};
    notes.clear();
    expect_box(file.read(&notes), vec3(0), vec3(2, 3, 5), 30);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "read all nodes, because no scene has a mesh");
}

TEST(Gltf, FarAwayToTheLastDigit) {
    Making file = a_brick(1e-3f);
    file.node()["translation"] = {4e6, 1e6, -2e6};  // as on the Earth
    std::vector<std::string> notes;
    const Mesh mesh = file.read(&notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "moved to the origin");
    EXPECT_LE(glm::distance(bounds(mesh).size(), vec3(2e-3f, 3e-3f, 5e-3f)), 2e-9f);
    Making lost;
    lost.primitive()["attributes"]["POSITION"] = lost.vectors({{4e6f, 0, 0}, {4e6f, 1, 0}, {4e6f, 0, 1}});
    EXPECT_HAS(lost.refused(), "move it to the origin first");
}

// ---- other files ----

TEST(Gltf, NamesOfOtherFilesAreUris) {
    Scratch scratch;
    const Making file = a_brick();
    make_folder(scratch / "in");
    make_folder(scratch / "in" / "parts of it");
    put(scratch / "outside.bin", file.bytes);
    for (const char* name : {"box data.bin",
                             "Sch\xc3\xa4"
                             "del.bin",
                             "50%25.bin", "parts of it/b.bin"})
        put(scratch / "in" / name, file.bytes);
    const auto read = [&](const std::string& uri) {
        put(scratch / "in" / "a.gltf", file.gltf(uri));
        return read_mesh(scratch / "in" / "a.gltf");
    };
    for (const char* uri : {"box%20data.bin", "box data.bin", "Sch%C3%A4del.bin",
                            "Sch\xc3\xa4"
                            "del.bin",
                            "50%2525.bin", "50%25.bin", "parts%20of%20it/b.bin",
                            "./parts%20of%20it/../box%20data.bin", "parts of it\\b.bin"})
        expect_box(read(uri), vec3(0), vec3(2, 3, 5), 30);
    for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
                                   (scratch / "outside.bin").string(), std::string("none.bin"),
                                   std::string(".."), std::string(""), std::string("parts of it"),
                                   std::string("https://example.org/a.bin"), std::string("box data.bin%00")})
        EXPECT_HAS(refusal(scratch / "in" / "a.gltf", [&] { read(uri); }), "export it as one .glb") << uri;
    EXPECT_HAS(parse_error("a.gltf", file.gltf("box data.bin")), "\"box data.bin\"");
    put(scratch / "in" / "box data.bin", file.bytes.substr(0, 50));
    EXPECT_HAS(refusal(scratch / "in" / "a.gltf", [&] { read("box%20data.bin"); }), "truncated");
    // In the text itself, by percents.
    std::string inside = "data:,";
    for (char c : file.bytes) inside += fmt::format("%{:02x}", std::uint8_t(c));
    expect_box(parse_mesh(file.gltf(inside), "a.gltf"), vec3(0), vec3(2, 3, 5), 30);
}

}  // namespace
}  // namespace palpate
