// What assimp reads for us, and the fuzzers' seeds.
#include "palpate/base/files.h"
#include "palpate/mesh/read.h"
#include "tests/mesh/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace palpate {
namespace {

// A triangle with corners on the axes, in a buffer at `uri`, on nodes as given.
std::string gltf(const std::string& uri, const std::string& nodes, const std::string& roots = "0") {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [)" + roots +
           R"(]}], "nodes": [)" + nodes +
           R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}],
        "buffers": [{"byteLength": 36, "uri": ")" +
           uri + R"("}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]}]})";
}

const char* const embedded =
    "data:application/octet-stream;base64,AACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/";

std::string triangle_bytes() {
    const vec3 corners[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return {reinterpret_cast<const char*>(corners), sizeof corners};
}

TEST(Assimp, NodesMoveTurnAndMirrorWhatHangsOnThem) {
    const Mesh mesh = parse_mesh(gltf(embedded,
                                      R"({"mesh": 0, "translation": [1, 2, 3], "children": [1]},
                {"mesh": 0, "scale": [2, -1, 4]}, {"mesh": 0, "rotation": [0, 0, 0.70710678, 0.70710678]})",
                                      "0, 2"),
                                 "a.gltf", Units::centimetres);
    const std::vector<vec3> corners = {{2, 2, 3}, {1, 3, 3}, {1, 2, 4},  {3, 2, 3}, {1, 1, 3},
                                       {1, 2, 7}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    ASSERT_EQ(mesh.positions.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_LE(glm::length(mesh.positions[i] - 0.01f * corners[i]), 1e-8f) << i;
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {5, 4, 3}, {6, 7, 8}}));
    // As normals serve the positions, which are units along the axes: the mirrored ones point back through
    // it.
    const std::vector<vec3> normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},  {1, 0, 0}, {0, -1, 0},
                                       {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    ASSERT_EQ(mesh.normals.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(glm::length(mesh.normals[i] - normals[i]), 1e-6f) << i;
}

TEST(Assimp, OpensOtherFilesOnlyBesideTheFirst) {
    Scratch scratch;
    make_folder(scratch / "in");
    put(scratch / "a.bin", triangle_bytes());
    put(scratch / "in" / "b.bin", triangle_bytes());
    const auto read = [&](const std::string& uri) {
        put(scratch / "in" / "a.gltf", gltf(uri, R"({"mesh": 0})"));
        return read_mesh(scratch / "in" / "a.gltf", Units::metres);
    };
    EXPECT_EQ(read("b.bin").positions[2], vec3(0, 0, 1));
    for (const std::string& uri : {std::string("../a.bin"), (scratch / "a.bin").string(),
                                   std::string("c.bin"), std::string(".."), std::string("")})
        EXPECT_HAS(error_of(scratch / "in" / "a.gltf", [&] { read(uri); }), "assimp") << uri;
    EXPECT_HAS(parse_error("a.gltf", gltf("b.bin", R"({"mesh": 0})")), "assimp");
}

TEST(Assimp, RefusesWhatIsDamaged) {
    const std::string whole = read_text(PALPATE_SOURCE_DIR "/fuzz/seeds/glb/tetrahedron.glb");
    EXPECT_EQ(parse_mesh(whole, "a.glb", Units::metres).triangles.size(), 4u);
    std::mt19937 random(8);
    for (int i = 0; i < 15; ++i) {
        std::string bytes = whole;
        for (int flips = 1 + i % 4; flips > 0; --flips) bytes[random() % bytes.size()] = char(random());
        expect_sound_or_error("a.glb", bytes);
        expect_sound_or_error("a.glb", std::string_view(whole).substr(0, random() % whole.size()));
    }
    for (const char* name : {"a.glb", "a.gltf", "a.x3d", "a.fbx", "a.dae", "a.3ds", "a.lwo"})
        for (const std::string& bytes : {std::string(), std::string(500, '\0'), std::string("noise")})
            EXPECT_NE(parse_error(name, bytes), "no error") << name;
    EXPECT_HAS(parse_error("a.gltf", gltf(embedded, R"({"mesh": 0, "translation": [1e7, 0, 0]})")),
               "move it to the origin first");
    EXPECT_HAS(parse_error("a.gltf", gltf(embedded, R"({"mesh": 0, "scale": [1e38, 1e38, 1e38],
        "children": [1]}, {"mesh": 0, "scale": [1e38, 1e38, 1e38]})")),
               "not finite");
}

TEST(Assimp, OnePolygonalFileOfX3d) {
    const Mesh mesh = parse_mesh(
        "<X3D><Scene><Transform translation='0 0 1'><Shape><IndexedFaceSet convex='false' "
        "coordIndex='0 1 2 3 -1'><Coordinate point='0 0 0 2 -1 0 0.5 0 0 2 1 0'/></IndexedFaceSet></Shape>"
        "</Transform></Scene></X3D>",
        "a.x3d", Units::metres);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_LE(std::abs(area(mesh) - 0.5), 1e-6);
    for (vec3 p : mesh.positions) EXPECT_EQ(p.z, 1);
}

// One file of each format, as other programs wrote it, and how many triangles it has.
TEST(Assimp, ReadsWhatPeopleHave) {
    const std::filesystem::path models = "/usr/share/assimp/models";
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "assimp-testmodels is not available";
    const std::pair<const char*, std::size_t> files[] = {
        {"OBJ/box.obj", 12},
        {"PLY/cube.ply", 12},
        {"STL/sphereWithHole.stl", 0},
        {"OFF/Cube.off", 12},
        {"WRL/Wuson.wrl", 0},
        {"X3D/ComputerKeyboard.x3d", 0},
        {"FBX/box.fbx", 12},
        {"Collada/duck.dae", 4212},
        {"3DS/fels.3ds", 0},
        {"LWO/LWO2/box_2uv_1unused.lwo", 12},
        {"glTF2/BoxTextured-glTF/BoxTextured.gltf", 12},
        {"glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 12}};
    for (const auto& [name, triangles] : files) {
        const Mesh mesh = read_mesh(models / name, Units::metres);
        if (triangles > 0) EXPECT_EQ(mesh.triangles.size(), triangles) << name;
        EXPECT_FALSE(mesh.triangles.empty()) << name;
    }
}

// Among the seeds is each file that was once a finding.
TEST(Seeds, OfAllMeshFormatsAreSoundOrRefused) {
    int read = 0;
    for (const char* format : {"obj", "off", "ply", "stl", "wrl", "gltf", "glb", "x3d"})
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::filesystem::path(PALPATE_SOURCE_DIR) / "fuzz/seeds" / format)) {
            expect_sound_or_error(std::string("a.") + format, read_text(entry.path()));
            ++read;
        }
    EXPECT_GE(read, 16);
}

}  // namespace
}  // namespace palpate
