// Texture coordinates from files, what becomes of them, and maps made on the spot.
#include "palpate/mesh/repair.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <set>

namespace palpate {
namespace {

Mesh parse(const std::string& name, std::string_view bytes, std::vector<std::string>* notes = nullptr) {
    return parse_mesh(bytes, name, Units::metres, notes);
}

TEST(Texture, ACubesCornersHaveThreePlacesEach) {
    const Mesh plain = parse("a.obj", textured_cube(false)), cube = parse("a.obj", textured_cube());
    EXPECT_EQ(plain.positions.size(), 8u);
    EXPECT_TRUE(plain.uvs.empty());
    ASSERT_EQ(cube.positions.size(), 24u);
    ASSERT_EQ(cube.uvs.size(), 24u);
    ASSERT_EQ(cube.triangles.size(), 12u);
    for (std::size_t i = 0; i < 24; ++i) {  // vertices in the order in which the faces use them
        const float left = float(i / 4) / 8, right = i % 4 == 1 || i % 4 == 2;
        EXPECT_LE(glm::distance(cube.uvs[i], vec2(left + 0.1f * right, i % 4 > 1)), 1e-6f) << i;
    }
    std::set<std::uint32_t> places;
    for (std::uint32_t first : first_in_place(cube.positions)) places.insert(first);
    EXPECT_EQ(places.size(), 8u);
    EXPECT_NEAR(volume(cube), 1, 1e-6);
}

TEST(Texture, ObjSpellsThemInManyWays) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const std::vector<vec2> uvs = {{0.25f, 0}, {1, 0.5f}, {-2, 3}};
    const std::string places = "vt 0.25\nvt 1 0.5\nvt -2 3 7\n", normals = "vn 0 0 1\n";
    EXPECT_EQ(parse("a.obj", points + places + "f 1/1 2/2 3/3\n").uvs, uvs);
    EXPECT_EQ(parse("a.obj", points + places + "f -3/-3 -2/-2 -1/-1\n").uvs, uvs);
    const Mesh both = parse("a.obj", points + places + normals + "f 1/1/1 2/2/1 3/3/1\n");
    EXPECT_EQ(both.uvs, uvs);
    EXPECT_EQ(both.normals, std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_EQ(parse("a.obj", points + "f 1/1 2/2 3/3\n" + places).uvs, uvs);  // named before they come
    // One corner without: none at all, and the same vertices as if there never were any.
    const Mesh some = parse("a.obj", points + places + normals + "f 1/1/1 2//1 3/3/1\n");
    EXPECT_TRUE(some.uvs.empty());
    EXPECT_EQ(some.normals.size(), 3u);
    for (const std::string& bad :
         {places + "f 1/1 2/2 3/4\n", places + "f 1/1 2/2 3/-4\n", std::string("vt x\nf 1/1 2/1 3/1\n"),
          std::string("vt nan 1\nf 1/1 2/1 3/1\n")}) {
        std::vector<std::string> notes;
        EXPECT_TRUE(parse("a.obj", points + bad, &notes).uvs.empty());
        ASSERT_EQ(notes.size(), 1u);
        EXPECT_HAS(notes[0], "left the texture coordinates out");
    }
}

TEST(Texture, PlyHasThemUnderThreeNames) {
    auto ply = [](const std::string& properties, const std::string& more, const char* format = "ascii") {
        return fmt::format(
            "ply\nformat {} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{}"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n{}",
            format, properties, more);
    };
    const std::string rows = "0 0 0 0.25 0\n1 0 0 1 0.5\n0 1 0 -2 3\n3 0 1 2\n";
    const std::vector<vec2> uvs = {{0.25f, 0}, {1, 0.5f}, {-2, 3}};
    for (auto [u, v] : {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v")}) {
        const std::string names = fmt::format("property float {}\nproperty double {}\n", u, v);
        EXPECT_EQ(parse("a.ply", ply(names, rows)).uvs, uvs) << u;
        std::string binary;
        const vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (int i = 0; i < 3; ++i) {
            binary.append(reinterpret_cast<const char*>(&points[i]), sizeof points[i]);
            binary.append(reinterpret_cast<const char*>(&uvs[std::size_t(i)].x), 4);
            const double high = uvs[std::size_t(i)].y;
            binary.append(reinterpret_cast<const char*>(&high), 8);
        }
        const int face[] = {0, 1, 2};
        binary += '\3' + std::string(reinterpret_cast<const char*>(face), sizeof face);
        EXPECT_EQ(parse("a.ply", ply(names, binary, "binary_little_endian")).uvs, uvs) << u;
    }
    // What is no pair stays unread, as it always was.
    EXPECT_TRUE(parse("a.ply", ply("property float u\nproperty float w\n", rows)).uvs.empty());
    const std::string twice = "property float u\nproperty float v\nproperty float s\nproperty float t\n";
    EXPECT_TRUE(
        parse("a.ply", ply(twice, "0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n")).uvs.empty());
}

// glTF counts v down from the upper edge, X3D up.
TEST(Texture, IsTurnedUp) {
    const float numbers[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0.25f, 0.5f, 1};  // corners, then places
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers);
    for (std::size_t i = 0; i < sizeof numbers; i += 3) {  // 60 bytes: no rest
        const unsigned word = bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2];
        for (int shift : {18, 12, 6, 0}) base64 += digits[word >> shift & 63];
    }
    const std::string gltf =
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}],
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)" +
        base64 +
        R"("}], "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
        "max": [1, 1, 1]}, {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}]})";
    EXPECT_EQ(parse("a.gltf", gltf).uvs, (std::vector<vec2>{{0, 1}, {1, 0.75f}, {0.5f, 0}}));
    const Mesh x3d =
        parse("a.x3d",
              "<X3D><Scene><Shape><IndexedFaceSet coordIndex='0 1 2 -1' texCoordIndex='0 1 2 -1'>"
              "<Coordinate point='0 0 0 1 0 0 0 1 0'/><TextureCoordinate point='0 0 1 0.25 0.5 1'/>"
              "</IndexedFaceSet></Shape></Scene></X3D>");
    EXPECT_EQ(x3d.uvs, (std::vector<vec2>{{0, 0}, {1, 0.25f}, {0.5f, 1}}));
}

TEST(Texture, NormalsAcrossSeamsAreThoseOfOneVertex) {
    Mesh whole = torus(2, 0.7f, 11, 7);
    compute_normals(whole);
    Mesh apart = soup(whole);
    compute_normals_by_place(apart);
    const std::vector<std::uint32_t> first = first_in_place(apart.positions);
    ASSERT_EQ(apart.normals.size(), 3 * whole.triangles.size());
    for (std::size_t f = 0; f < whole.triangles.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const vec3 one = apart.normals[3 * f + std::size_t(k)],
                       other = whole.normals[whole.triangles[f][k]];
            EXPECT_LE(glm::distance(one, other), 1e-6f);
            EXPECT_EQ(one, apart.normals[first[3 * f + std::size_t(k)]]);
        }
    EXPECT_EQ(first_in_place({vec3(0, 1, 0), vec3(-0.0f, 1, 0), vec3(2), vec3(0, 1, 0)}),
              (std::vector<std::uint32_t>{0, 0, 2, 0}));
}

TEST(Texture, RepairMakesTheSameSolidWithOrWithout) {
    Mesh plain = parse("a.obj", textured_cube(false)), cube = parse("a.obj", textured_cube());
    EXPECT_TRUE(repair(plain).empty());
    EXPECT_FALSE(repair(cube).empty());
    EXPECT_EQ(cube.positions, plain.positions);
    EXPECT_EQ(cube.triangles, plain.triangles);
    EXPECT_TRUE(cube.uvs.empty());
}

}  // namespace
}  // namespace palpate
