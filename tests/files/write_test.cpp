// The formats that are only written here; what read_mesh reads too, read_mesh_test.cpp sends there and back.
#include "palpate/files/write.h"

#include "palpate/base/files.h"
#include "tests/files/glb.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

// Triangles in no order over random vertices, some of them without an area, with unit normals.
Mesh random_mesh(unsigned vertices, bool normals) {
    std::mt19937 random(vertices);
    std::normal_distribution<float> any;
    Mesh mesh;
    for (unsigned i = 0; i < vertices; ++i) {
        mesh.positions.push_back({any(random), any(random), 100 * any(random)});
        if (normals) mesh.normals.push_back(glm::normalize(vec3(any(random), any(random), any(random))));
    }
    for (unsigned i = 0; i < 2 * vertices; ++i)
        mesh.triangles.push_back(
            {i % vertices, unsigned(random()) % vertices, unsigned(random()) % vertices});
    return mesh;
}

TEST(WriteMesh, RefusesOtherEndingsAndLeavesNothing) {
    Scratch scratch;
    for (const char* name : {"a.xyz", "a", "ply", "a.pc2"}) {
        const std::string line =
            refusal(scratch / name, [&] { write_mesh(box(vec3(0), vec3(1)), scratch / name); });
        EXPECT_HAS(line, ".ply, .obj, .stl, .vtp, .glb or .gltf");
    }
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(WriteMesh, StlHasEachFaceWithItsNormal) {
    Scratch scratch;
    for (unsigned vertices : {3, 10, 257}) {
        const Mesh mesh = random_mesh(vertices, vertices % 2);
        write_mesh(mesh, scratch / "a.STL");
        const std::string file = read_text(scratch / "a.STL");
        EXPECT_FALSE(file.starts_with("solid"));
        ASSERT_EQ(file.size(), 84 + 50 * mesh.triangles.size());
        EXPECT_EQ(at<std::uint32_t>(file, 80), mesh.triangles.size());
        for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(at<vec3>(file, 84 + 50 * f + 12 * (k + 1)), mesh.positions[mesh.triangles[f][k]]);
            const uvec3 t = mesh.triangles[f];
            const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            const vec3 normal = at<vec3>(file, 84 + 50 * f);
            if (t.x == t.y || t.y == t.z || t.z == t.x)
                EXPECT_EQ(normal, vec3(0));
            else
                EXPECT_LE(glm::distance(dvec3(normal), glm::normalize(glm::cross(b - a, c - b))), 1e-6);
            EXPECT_EQ(at<std::uint16_t>(file, 84 + 50 * f + 48), 0);
        }
    }
}

TEST(WriteMesh, StlKeepsTheNormalsOfTheSmallestAndTheLargestFaces) {
    Scratch scratch;
    for (float size : {1e-38f, 1e-20f, 1e30f, 1e38f}) {
        write_mesh(box(vec3(-size), vec3(size)), scratch / "a.stl");
        const std::string file = read_text(scratch / "a.stl");
        for (std::size_t f = 0; f < 12; ++f)
            EXPECT_LE(std::abs(glm::length(at<vec3>(file, 84 + 50 * f)) - 1), 1e-6f) << size;
    }
}

// The block of numbers of one array in a VTP file.
std::string vtp_block(const std::string& file, const std::string& name) {
    const std::size_t element = file.find("Name=\"" + name + "\"");
    EXPECT_NE(element, std::string::npos) << name;
    const std::size_t offset = std::stoull(file.substr(file.find("offset=\"", element) + 8));
    const std::size_t begin = file.find("\n_", file.find("<AppendedData")) + 2 + offset;
    return file.substr(begin + 8, at<std::uint64_t>(file, begin));
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

TEST(WriteMesh, VtpHasTheSameNumbers) {
    Scratch scratch;
    for (unsigned vertices : {3, 11, 258}) {
        const bool normals = vertices != 11;
        const Mesh mesh = random_mesh(vertices, normals);
        write_mesh(mesh, scratch / "a.vtp");
        const std::string file = read_text(scratch / "a.vtp");
        EXPECT_HAS(file.substr(0, 600), "NumberOfPoints=\"" + std::to_string(vertices) + "\"");
        EXPECT_HAS(file.substr(0, 600), "NumberOfPolys=\"" + std::to_string(2 * vertices) + "\"");
        EXPECT_EQ(vtp_block(file, "Points"), bytes_of(mesh.positions));
        EXPECT_EQ(vtp_block(file, "connectivity"), bytes_of(mesh.triangles));
        std::vector<std::int32_t> ends;
        for (std::size_t f = 1; f <= mesh.triangles.size(); ++f) ends.push_back(std::int32_t(3 * f));
        EXPECT_EQ(vtp_block(file, "offsets"), bytes_of(ends));
        if (normals) EXPECT_EQ(vtp_block(file, "Normals"), bytes_of(mesh.normals));
        EXPECT_EQ(file.find("Name=\"Normals\"") != std::string::npos, normals);
        EXPECT_TRUE(file.ends_with("\n</AppendedData>\n</VTKFile>\n"));
    }
}

// Where the format has a place for it, a number for each vertex; elsewhere the same file as without.
TEST(WriteMesh, WritesAValueForEachVertex) {
    Scratch scratch;
    const Mesh mesh = random_mesh(20, true);
    std::vector<float> pressures;
    for (int v = 0; v < 20; ++v) pressures.push_back(0.5f * float(v));
    write_mesh(mesh, scratch / "a.ply", {"pressure", pressures});
    const std::string ply = read_text(scratch / "a.ply");
    const std::size_t begins = ply.find("end_header\n") + 11;
    EXPECT_NE(ply.find("property float pressure\nelement face"), ply.npos);
    for (std::size_t v = 0; v < 20; ++v) EXPECT_EQ(at<float>(ply, begins + 28 * v + 24), pressures[v]);
    EXPECT_EQ(read_mesh(scratch / "a.ply", Units::metres).triangles, mesh.triangles);
    write_mesh(mesh, scratch / "a.vtp", {"pressure", pressures});
    const std::string vtp = read_text(scratch / "a.vtp");
    EXPECT_NE(vtp.find("Name=\"pressure\" NumberOfComponents=\"1\""), vtp.npos);
    EXPECT_NE(vtp.find(std::string(reinterpret_cast<const char*>(pressures.data()), 80)), vtp.npos);
    for (const char* name : {"a.obj", "a.stl", "a.glb", "a.gltf"}) {
        write_mesh(mesh, scratch / name);
        const std::string without = read_text(scratch / name);
        write_mesh(mesh, scratch / name, {"pressure", pressures});
        EXPECT_EQ(read_text(scratch / name), without) << name;
    }
    pressures.pop_back();
    EXPECT_HAS(refusal(scratch / "b.ply",
                       [&] {
                           write_mesh(mesh, scratch / "b.ply", {"pressure", pressures});
                       }),
               "19 values for 20 vertices");
}

TEST(WriteMesh, GlbKeepsTheFormatsRulesAndTheSameNumbers) {
    Scratch scratch;
    for (unsigned vertices : {3, 11, 258, 5001}) {
        const bool normals = vertices != 11;
        const Mesh mesh = random_mesh(vertices, normals);
        write_mesh(mesh, scratch / "a.glb");
        const Gltf gltf = read_glb(scratch / "a.glb");
        EXPECT_EQ(gltf.positions(gltf.primitive()["attributes"]["POSITION"]), mesh.positions);
        EXPECT_EQ(gltf.primitive()["attributes"].contains("NORMAL"), normals);
        if (normals) EXPECT_EQ(gltf.numbers<vec3>(gltf.primitive()["attributes"]["NORMAL"]), mesh.normals);
        const auto corners = gltf.numbers<std::uint32_t>(gltf.primitive()["indices"]);
        EXPECT_EQ(bytes_of(corners), bytes_of(mesh.triangles));
        EXPECT_FALSE(gltf.json.contains("animations"));
    }
}

TEST(WriteMesh, GltfsNormalsAreUnitWhateverTheMeshs) {
    Scratch scratch;
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {3, 0, 4}, {0, NAN, 0}}, {{0, 1, 2}}};
    write_mesh(mesh, scratch / "a.glb");
    const Gltf gltf = read_glb(scratch / "a.glb");
    const auto normals = gltf.numbers<vec3>(gltf.primitive()["attributes"]["NORMAL"]);
    EXPECT_EQ(normals, (std::vector<vec3>{{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0, 1}}));
}

TEST(WriteMesh, GltfHoldsItsBinaryAsText) {
    Scratch scratch;
    for (unsigned vertices : {3, 4, 5}) {  // the length by threes: nothing, one and two bytes are left
        const Mesh mesh = random_mesh(vertices, true);
        write_mesh(mesh, scratch / "a.gltf");
        write_mesh(mesh, scratch / "a.glb");
        const auto json = nlohmann::json::parse(read_text(scratch / "a.gltf"));
        const std::string uri = json["buffers"][0]["uri"], start = "data:application/octet-stream;base64,";
        ASSERT_TRUE(uri.starts_with(start));
        std::string binary;
        unsigned word = 0;
        const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (std::size_t i = start.size(); i < uri.size(); ++i) {
            word = word << 6 | unsigned(digits.find(uri[i]) & 63);
            if ((i - start.size()) % 4 != 3) continue;
            for (int shift : {16, 8, 0}) binary += char(word >> shift);
            word = 0;
        }
        binary.resize(binary.size() - std::size_t(std::count(uri.begin(), uri.end(), '=')));
        EXPECT_EQ(binary, read_glb(scratch / "a.glb").binary);
    }
}

TEST(WriteMesh, WhatHasNoTrianglesIsWrittenWhereTheFormatCan) {
    Scratch scratch;
    for (const char* name : {"a.ply", "a.obj", "a.stl", "a.vtp"}) write_mesh({}, scratch / name);
    for (const char* name : {"a.glb", "a.gltf"})
        EXPECT_HAS(refusal(scratch / name, [&] { write_mesh({}, scratch / name); }), "no triangles");
    EXPECT_EQ(scratch.entries(), 4u);
}

}  // namespace
}  // namespace palpate
