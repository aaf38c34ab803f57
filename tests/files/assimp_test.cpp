// What assimp reads for us, and the fuzzers' seeds.
#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "tests/files/collada.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace palpate {
namespace {

// A triangle with corners on the axes, in the words of 3DS: chunks, each with its kind and length.
std::string chunk(std::uint16_t kind, const std::string& content) {
    const auto length = std::uint32_t(6 + content.size());
    return std::string(reinterpret_cast<const char*>(&kind), 2) +
           std::string(reinterpret_cast<const char*>(&length), 4) + content;
}

std::string triangle_of_3ds() {
    const vec3 corners[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::uint16_t faces[] = {1, 0, 1, 2, 0};
    const std::string points =
        std::string("\3\0", 2) + std::string(reinterpret_cast<const char*>(corners), sizeof corners);
    const std::string mesh =
        chunk(0x4110, points) + chunk(0x4120, {reinterpret_cast<const char*>(faces), sizeof faces});
    return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, std::string("a\0", 2) + chunk(0x4100, mesh))));
}

// Each vertex goes by its joint, which is scaled by 0.01; the node of the mesh, scaled by 7, places nothing.
TEST(Assimp, ASkinPlacesItsVertices) {
    const auto source = [](const std::string& id, const std::string& type, int count,
                           const std::string& values, const std::string& of) {
        return fmt::format(
            "<source id='{0}'><{1}_array id='{0}a' count='{2}'>{3}</{1}_array><technique_common><accessor "
            "source='#{0}a' count='1' stride='{2}'><param name='X' "
            "type='{4}'/></accessor></technique_common></source>",
            id, type, count, values, of);
    };
    const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    const std::string skin =
        "<library_controllers><controller id='c'><skin source='#g'><bind_shape_matrix>" + identity +
        "</bind_shape_matrix>" + source("j", "Name", 1, "J", "name") +
        source("b", "float", 16, identity, "float4x4") + source("w", "float", 1, "1", "float") +
        "<joints><input semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' "
        "source='#b'/></joints>"
        "<vertex_weights count='8'><input semantic='JOINT' source='#j' offset='0'/><input semantic='WEIGHT' "
        "source='#w' offset='1'/><vcount>1 1 1 1 1 1 1 1</vcount><v>0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0</v>"
        "</vertex_weights></skin></controller></library_controllers>";
    const std::string nodes =
        "<node id='a'><scale>0.01 0.01 0.01</scale><node id='J' sid='J' name='J' type='JOINT'/></node><node "
        "id='n'>"
        "<scale>7 7 7</scale><instance_controller "
        "url='#c'><skeleton>#J</skeleton></instance_controller></node>";
    const Mesh mesh = parse_mesh(collada("", nodes, skin), "a.dae");
    EXPECT_LE(glm::distance(bounds(mesh).low, vec3(0)), 1e-6f);
    EXPECT_LE(glm::distance(bounds(mesh).high, vec3(0.02f, 0.03f, 0.05f)), 1e-6f);
    EXPECT_LE(std::abs(volume(mesh) / 30e-6 - 1), 1e-4);
}

TEST(Assimp, AnAxisOfColladaMayHaveAnyLength) {
    const auto read = [](const char* axis) {
        return parse_mesh(
            collada("", fmt::format("<node><rotate sid='r'>{} 63.025357</rotate><instance_geometry "
                                    "url='#g'/></node>",
                                    axis)),
            "a.dae");
    };
    for (const char* axis : {"1 2 3", "0.26726124 0.53452248 0.80178373", " 100\n200 300 "}) {
        const Mesh mesh = read(axis);
        EXPECT_LE(glm::distance(bounds(mesh).low, vec3(-1.909f, -0.020f, -0.719f)), 1e-3f) << axis;
        EXPECT_LE(glm::distance(bounds(mesh).high, vec3(3.953f, 3.414f, 5.441f)), 1e-3f) << axis;
        EXPECT_LE(std::abs(volume(mesh) - 30), 1e-3) << axis;
    }
    EXPECT_NE(parse_error("a.dae", "<rotate"), "");
    EXPECT_NE(parse_error("a.dae", "<rotate>1 2"), "");
}

TEST(Assimp, RefusesWhatIsDamaged) {
    const std::string whole = triangle_of_3ds();
    EXPECT_EQ(parse_mesh(whole, "a.3ds").triangles.size(), 1u);
    std::mt19937 random(8);
    for (int i = 0; i < 15; ++i) {
        std::string bytes = whole;
        for (int flips = 1 + i % 4; flips > 0; --flips) bytes[random() % bytes.size()] = char(random());
        expect_sound_or_error("a.3ds", bytes);
        expect_sound_or_error("a.3ds", std::string_view(whole).substr(0, random() % whole.size()));
    }
    for (const char* name : {"a.glb", "a.gltf", "a.x3d", "a.3mf", "a.fbx", "a.dae", "a.3ds", "a.lwo"})
        for (const std::string& bytes : {std::string(), std::string(500, '\0'), std::string("noise")})
            EXPECT_NE(parse_error(name, bytes), "") << name;
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
        {"glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 12},
        {"glTF/BoxTextured-glTF/BoxTextured.gltf", 12},  // of version 1
        {"3MF/box.3mf", 12}};
    for (const auto& [name, triangles] : files) {
        const Mesh mesh = read_mesh(models / name, Units::metres);
        if (triangles > 0) EXPECT_EQ(mesh.triangles.size(), triangles) << name;
        EXPECT_FALSE(mesh.triangles.empty()) << name;
    }
}

// Among the seeds is each file that was once a finding.
TEST(Seeds, OfAllMeshFormatsAreSoundOrRefused) {
    int read = 0;
    for (const char* format : {"obj", "off", "ply", "stl", "wrl", "gltf", "glb", "x3d", "3mf", "dae"})
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::filesystem::path(PALPATE_SOURCE_DIR) / "fuzz/seeds" / format)) {
            expect_sound_or_error(std::string("a.") + format, read_text(entry.path()));
            ++read;
        }
    EXPECT_GE(read, 16);
}

}  // namespace
}  // namespace palpate
