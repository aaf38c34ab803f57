// glTF as other programs write it: where its vertices are at rest, and what it may require.
#include "palpate/base/files.h"
#include "palpate/mesh/read.h"
#include "tests/mesh/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <map>
#include <random>

namespace palpate {
namespace {

using Json = nlohmann::json;

constexpr int int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126;

// A file in the making: its JSON, and the bytes that its accessors lie in.
struct Making {
    Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}]})");
    std::string bytes;

    Json& primitive() { return json["meshes"][0]["primitives"][0]; }
    Json& node() { return json["nodes"][0]; }

    int view(std::string_view content, std::size_t stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}};
        if (stride > 0) view["byteStride"] = stride;
        json["bufferViews"].push_back(view);
        bytes += content;
        return int(json["bufferViews"].size()) - 1;
    }

    // Of numbers in a row; each entry of a shape begins on a multiple of four bytes, as vertices must.
    template <class T>
    int accessor(const std::vector<T>& numbers, int kind, const char* shape, bool normalized = false) {
        const std::map<std::string, std::size_t> sizes = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        const std::size_t each = sizes.at(shape),
                          filled = each == 1 ? sizeof(T) : (each * sizeof(T) + 3) / 4 * 4;
        std::string content;
        for (std::size_t i = 0; i < numbers.size(); i += each) {
            content.append(reinterpret_cast<const char*>(&numbers[i]), each * sizeof(T));
            content.resize(content.size() + filled - each * sizeof(T));
        }
        json["accessors"].push_back({{"bufferView", view(content, each == 1 ? 0 : filled)},
                                     {"componentType", kind},
                                     {"count", numbers.size() / each},
                                     {"type", shape}});
        if (normalized) json["accessors"].back()["normalized"] = true;
        return int(json["accessors"].size()) - 1;
    }
    int vectors(const std::vector<vec3>& list) {
        std::vector<float> numbers;
        for (vec3 v : list) numbers.insert(numbers.end(), {v.x, v.y, v.z});
        return accessor(numbers, float32, "VEC3");
    }
    int triangles(const Mesh& mesh) {
        std::vector<std::uint16_t> corners;
        for (uvec3 t : mesh.triangles)
            for (int k = 0; k < 3; ++k) corners.push_back(std::uint16_t(t[k]));
        return accessor(corners, uint16, "SCALAR");
    }

    std::string glb() const {
        const auto word = [](std::size_t n) {
            const auto number = std::uint32_t(n);
            return std::string(reinterpret_cast<const char*>(&number), 4);
        };
        Json whole = json;
        whole["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = whole.dump(), binary = bytes;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4);
        return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
               word(binary.size()) + std::string("BIN\0", 4) + binary;
    }
    // As a text, with its bytes in another file.
    std::string gltf(const std::string& uri) const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
        return whole.dump();
    }
    Mesh read(std::vector<std::string>* notes = nullptr) const {
        return parse_mesh(glb(), "a.glb", {}, notes);
    }
    std::string refused() const { return parse_error("a.glb", glb()); }
};

const Mesh brick = box(vec3(0), vec3(2, 3, 5));

Making a_brick(float scale = 1) {
    Making file;
    std::vector<vec3> corners = brick.positions;
    for (vec3& p : corners) p *= scale;
    file.primitive()["attributes"]["POSITION"] = file.vectors(corners);
    file.primitive()["indices"] = file.triangles(brick);
    return file;
}

void expect_box(const Mesh& mesh, vec3 low, vec3 high, double of_volume, float error = 1e-5f) {
    const Bounds around = bounds(mesh);
    EXPECT_LE(glm::distance(around.low, low), error)
        << around.low.x << ' ' << around.low.y << ' ' << around.low.z;
    EXPECT_LE(glm::distance(around.high, high), error)
        << around.high.x << ' ' << around.high.y << ' ' << around.high.z;
    EXPECT_LE(std::abs(volume(mesh) - of_volume), 20 * error * of_volume);
}

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
    EXPECT_HAS(file.refused(), "morph target of another number");
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
    EXPECT_HAS(file.refused(), "different number");
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

// ---- how the numbers lie ----

template <class T>
Making quantised(int kind, bool normalized, double most) {
    Making file;
    std::vector<T> numbers;
    for (vec3 p : brick.positions)
        for (int k = 0; k < 3; ++k) numbers.push_back(T(std::lround(p[k] / 5 * (normalized ? most : 100))));
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.primitive()["attributes"]["POSITION"] = file.accessor(numbers, kind, "VEC3", normalized);
    file.primitive()["indices"] = file.triangles(brick);
    const double scale = normalized ? 5 : 0.05;
    file.node()["scale"] = {scale, scale, scale};
    return file;
}

TEST(Gltf, WholeNumbersArePositionsToo) {
    expect_box(quantised<std::int8_t>(int8, true, 127).read(), vec3(0), vec3(2, 3, 5), 30, 0.02f);
    expect_box(quantised<std::uint8_t>(uint8, true, 255).read(), vec3(0), vec3(2, 3, 5), 30, 1e-5f);
    expect_box(quantised<std::int16_t>(int16, true, 32767).read(), vec3(0), vec3(2, 3, 5), 30, 1e-4f);
    expect_box(quantised<std::uint16_t>(uint16, true, 65535).read(), vec3(0), vec3(2, 3, 5), 30, 1e-4f);
    expect_box(quantised<std::int8_t>(int8, false, 0).read(), vec3(0), vec3(2, 3, 5), 30);
    expect_box(quantised<std::uint16_t>(uint16, false, 0).read(), vec3(0), vec3(2, 3, 5), 30);
}

TEST(Gltf, SparseAccessorsGiveSomeEntriesAnew) {
    Making file = a_brick();
    file.json["accessors"].push_back({{"componentType", float32}, {"count", 8}, {"type", "VEC3"}});
    Json& zeros = file.json["accessors"].back();
    file.primitive()["attributes"]["POSITION"] = 2;
    const std::vector<std::uint8_t> places = {1, 2, 3, 4, 5, 6, 7};
    std::vector<float> values;
    for (std::uint8_t i : places)
        for (int k = 0; k < 3; ++k) values.push_back(brick.positions[i][k]);
    const auto text = [](const auto& list) {
        return std::string_view(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
    };
    zeros["sparse"] = {{"count", 7},
                       {"indices", {{"bufferView", file.view(text(places))}, {"componentType", uint8}}},
                       {"values", {{"bufferView", file.view(text(values))}}}};
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    file.json["accessors"][2]["count"] = 7;
    EXPECT_HAS(file.refused(), "entry 7 of 7");
}

TEST(Gltf, StripsFansPointsAndLines) {
    Making file;
    file.primitive()["attributes"]["POSITION"] =
        file.vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}});
    file.primitive()["mode"] = 5;
    const Mesh strip = file.read();
    EXPECT_EQ(strip.triangles, (std::vector<uvec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}));
    file.primitive()["mode"] = 6;
    file.primitive()["indices"] = file.accessor(std::vector<std::uint32_t>{0, 1, 3, 2}, uint32, "SCALAR");
    EXPECT_EQ(file.read().triangles, (std::vector<uvec3>{{1, 3, 0}, {3, 2, 0}}));
    // A primitive of each other kind: 6 points, 3 lines, 6 and 5.
    for (int mode : {0, 1, 2, 3})
        file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
    std::vector<std::string> notes;
    EXPECT_EQ(file.read(&notes).positions.size(), 6u) << "whose vertices are shared";
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 20 points and lines");
    file.primitive()["mode"] = 4;
    notes.clear();
    EXPECT_EQ(file.read(&notes).triangles.size(), 1u);
    EXPECT_HAS(notes[0], "left out 1 corners that make no whole triangle");
    file.primitive()["mode"] = 7;
    EXPECT_HAS(file.refused(), "unknown mode 7");
}

TEST(Gltf, PackedByMeshoptimizer) {
    Making file;
    std::vector<float> numbers;
    for (vec3 p : brick.positions) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    std::vector<unsigned> corners;
    for (uvec3 t : brick.triangles) corners.insert(corners.end(), {t.x, t.y, t.z});
    std::vector<unsigned char> room(10000);
    const auto pack = [&](std::size_t size, const char* mode, std::size_t count, std::size_t stride) {
        const int view = file.view({reinterpret_cast<const char*>(room.data()), size});
        Json& packed = file.json["bufferViews"][std::size_t(view)];
        Json extension = packed;
        extension.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
        packed["extensions"]["EXT_meshopt_compression"] = extension;
        return view;
    };
    const int vertices = pack(meshopt_encodeVertexBuffer(room.data(), room.size(), numbers.data(), 8, 12),
                              "ATTRIBUTES", 8, 12);
    const int triangles =
        pack(meshopt_encodeIndexBuffer(room.data(), room.size(), corners.data(), 36), "TRIANGLES", 36, 4);
    const int sequence =
        pack(meshopt_encodeIndexSequence(room.data(), room.size(), corners.data(), 36), "INDICES", 36, 4);
    file.json["accessors"] = {
        {{"bufferView", vertices}, {"componentType", float32}, {"count", 8}, {"type", "VEC3"}},
        {{"bufferView", triangles}, {"componentType", uint32}, {"count", 36}, {"type", "SCALAR"}},
        {{"bufferView", sequence}, {"componentType", uint32}, {"count", 36}, {"type", "SCALAR"}}};
    file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.primitive()["attributes"]["POSITION"] = 0;
    for (int indices : {1, 2}) {
        file.primitive()["indices"] = indices;
        expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    }
    // Numbers of exponent and mantissa: 2^E * M, here with E = -3.
    for (float& n : numbers) {
        const std::uint32_t packed = 0xfd000000u | std::uint32_t(n * 8);
        std::memcpy(&n, &packed, 4);
    }
    file.json["accessors"][0]["bufferView"] = pack(
        meshopt_encodeVertexBuffer(room.data(), room.size(), numbers.data(), 8, 12), "ATTRIBUTES", 8, 12);
    Json& extension = file.json["bufferViews"].back()["extensions"]["EXT_meshopt_compression"];
    extension["filter"] = "EXPONENTIAL";
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
    extension["byteStride"] = 10;
    EXPECT_HAS(file.refused(), "a stride of 10 in meshopt's compression, which is no multiple of 4");
    extension["byteStride"] = 12;
    extension["count"] = 1'000'000'000'000;
    EXPECT_HAS(file.refused(), "more than the file's size warrants");
    extension["count"] = 100;
    EXPECT_HAS(file.refused(), "damaged meshopt");
    extension["mode"] = "OTHER";
    EXPECT_HAS(file.refused(), "\"OTHER\"");
}

Making packed_by_draco(const Mesh& mesh) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(int(mesh.triangles.size()));
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (unsigned f = 0; f < mesh.triangles.size(); ++f) {
        const uvec3 t = mesh.triangles[f];
        builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), &mesh.positions[t.x], &mesh.positions[t.y],
                                          &mesh.positions[t.z]);
    }
    draco::EncoderBuffer packed;
    EXPECT_TRUE(draco::Encoder().EncodeMeshToBuffer(*builder.Finalize(), &packed).ok());
    Making file;
    const int view = file.view({packed.data(), packed.size()});
    file.json["accessors"] = {
        {{"componentType", float32}, {"count", mesh.positions.size()}, {"type", "VEC3"}},
        {{"componentType", uint32}, {"count", 3 * mesh.triangles.size()}, {"type", "SCALAR"}}};
    file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    file.primitive() = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                    {"attributes", {{"POSITION", 0}}}};
    return file;
}

TEST(Gltf, PackedByDraco) {
    Making file = packed_by_draco(brick);
    Json& extension = file.primitive()["extensions"]["KHR_draco_mesh_compression"];
    file.node()["translation"] = {1, 0, 0};
    expect_box(file.read(), vec3(1, 0, 0), vec3(3, 3, 5), 30);
    extension["attributes"]["POSITION"] = 7;
    EXPECT_HAS(file.refused(), "no attribute 7 in what Draco packed");
    extension["attributes"]["POSITION"] = 0;
    file.json["accessors"][0]["count"] = 9;
    EXPECT_HAS(file.refused(), "another number of vertices");
    file.bytes.resize(file.bytes.size() - 5);
    file.json["bufferViews"][0]["byteLength"] = file.bytes.size();
    EXPECT_HAS(file.refused(), "damaged Draco");
}

TEST(Gltf, ATextureMayBeTurnedInItsPicture) {
    Making file;
    file.primitive()["attributes"]["POSITION"] = file.vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, float32, "VEC2");
    file.primitive()["attributes"]["TEXCOORD_1"] =
        file.accessor(std::vector<std::uint16_t>{0, 0, 65535, 0, 0, 65535}, uint16, "VEC2", true);
    EXPECT_EQ(file.read().uvs, (std::vector<vec2>{{0, 1}, {1, 1}, {0, 0}}));
    file.primitive()["material"] = 0;
    file.json["materials"] = Json::parse(
        R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 7, "extensions":
            {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5],
                                       "texCoord": 1}}}}}])");
    file.json["extensionsRequired"] = {"KHR_texture_transform"};
    // The lower left quarter of the picture, turned clockwise: this example stands in the extension's own
    // text.
    const std::vector<vec2> turned = {{0, 0}, {0, 0.5f}, {0.5f, 0}}, found = file.read().uvs;
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(glm::distance(found[i], turned[i]), 1e-6f) << i;
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
    EXPECT_HAS(notes[0], "left out 1 scenes");
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
    EXPECT_HAS(notes[0], "left out 1 nodes that are not visible");
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

// ---- what is damaged ----

TEST(Gltf, NothingIsMadeOfClaims) {
    Making file = a_brick();
    file.json["accessors"].push_back(
        {{"componentType", float32}, {"count", 1'000'000'000'000}, {"type", "VEC3"}});
    file.primitive()["attributes"]["POSITION"] = 2;
    EXPECT_HAS(file.refused(), "more than the file's size warrants");
    file = a_brick();
    file.json["accessors"][0]["count"] = 1'000'000'000;
    EXPECT_HAS(file.refused(), "1000000000 entries promised in 96 bytes");
    // A thousand copies of many vertices, which lie nowhere and are all zero.
    file = a_brick();
    file.json["accessors"].push_back({{"componentType", float32}, {"count", 200'000}, {"type", "VEC3"}});
    file.primitive()["attributes"]["POSITION"] = 2;
    file.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        file.vectors(std::vector<vec3>(1000));
    EXPECT_HAS(file.refused(), "more than the file's size warrants");
}

TEST(Gltf, WhatIsRepeatedIsCountedBeforeItIsMade) {
    const std::string too_much = "more than the file's size warrants";
    // What Draco unpacked, by morph targets.
    Mesh net;
    constexpr unsigned wide = 100;
    for (unsigned y = 0; y < wide; ++y)
        for (unsigned x = 0; x < wide; ++x) {
            const auto i = unsigned(net.positions.size());
            net.positions.push_back(vec3(x, y, 0));
            if (x > 0 && y > 0) {
                net.triangles.push_back({i - wide - 1, i - wide, i});
                net.triangles.push_back({i - wide - 1, i, i - 1});
            }
        }
    Making file = packed_by_draco(net);
    EXPECT_EQ(file.read().positions.size(), net.positions.size());
    for (int i = 0; i < 1500; ++i) {
        file.primitive()["targets"].push_back({{"POSITION", 0}});
        file.node()["weights"].push_back(1);
    }
    EXPECT_HAS(file.refused(), too_much);
    // Empty primitives, by nodes.
    constexpr int many = 2000;
    file = Making();
    file.json.erase("scenes");
    for (int i = 0; i < many; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["meshes"][0]["primitives"].push_back(Json::object());
    }
    EXPECT_HAS(file.refused(), too_much);
    // Joints of a skin without matrices.
    file = Making();
    file.json.erase("scenes");
    file.json["meshes"][0]["primitives"].clear();
    for (int i = 0; i < many; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
        file.json["skins"][0]["joints"].push_back(i);
    }
    EXPECT_HAS(file.refused(), too_much);
}

TEST(Gltf, AFileThatManyBuffersNameCountsOnce) {
    Scratch scratch;
    const std::size_t size = std::size_t(4) << 20;
    put(scratch / "zeros.bin", std::string(size, '\0'));
    Making file;
    for (int i = 0; i < 140; ++i) {
        file.json["buffers"].push_back({{"byteLength", size}, {"uri", "zeros.bin"}});
        file.json["bufferViews"].push_back({{"buffer", i}, {"byteLength", 36}});
        file.json["accessors"].push_back(
            {{"bufferView", i}, {"componentType", float32}, {"count", 3}, {"type", "VEC3"}});
        file.json["meshes"][0]["primitives"][i] = {{"attributes", {{"POSITION", i}}}};
    }
    put(scratch / "a.gltf", file.json.dump());
    EXPECT_HAS(refusal(scratch / "a.gltf", [&] { read_mesh(scratch / "a.gltf"); }),
               "more than the file's size warrants");
}

TEST(Gltf, NodesThatGoInCirclesAreRefused) {
    Making file = a_brick();
    file.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
    EXPECT_HAS(file.refused(), "hang on themselves");
    file.json["nodes"] = {{{"mesh", 0}, {"children", {2}}}, {{"children", {2}}}, Json::object()};
    EXPECT_HAS(file.refused(), "hangs on two");
    Json chain;
    for (int i = 0; i < 100'000; ++i) chain.push_back({{"children", {i + 1}}});
    chain.push_back({{"mesh", 0}});
    file.json["nodes"] = chain;
    expect_box(file.read(), vec3(0), vec3(2, 3, 5), 30);
}

TEST(Gltf, RefusesWhatIsDamaged) {
    const Making good = a_brick();
    const std::string whole = good.glb();
    for (std::size_t length = 0; length < whole.size(); length += 7)
        EXPECT_NE(parse_error("a.glb", std::string_view(whole).substr(0, length)), "") << length;
    std::mt19937 random(8);
    for (int i = 0; i < 300; ++i) {
        std::string bytes = whole;
        for (int flips = 1 + i % 4; flips > 0; --flips) bytes[random() % bytes.size()] = char(random());
        expect_sound_or_error("a.glb", bytes);
    }
    // Each entry of the JSON by something else.
    const Json flat = good.json.flatten();
    for (const auto& [path, value] : flat.items())
        for (const Json& other : {Json(), Json("x"), Json(-1), Json(1e300), Json(0.5), Json(99), Json(true),
                                  Json::array(), Json::object()}) {
            Making bad = good;
            bad.json[Json::json_pointer(path)] = other;
            expect_sound_or_error("a.glb", bad.glb());
        }
    std::string deep = R"({"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": )";
    for (int i = 0; i < 200'000; ++i) deep += R"({"POSITION": )";
    EXPECT_NE(parse_error("a.gltf", deep), "");
    for (int i = 0; i < 200'000; ++i) deep += '}';
    EXPECT_NE(parse_error("a.gltf", deep), "");
    EXPECT_NE(parse_error("a.gltf", deep + "}]}]}"), "");
}

TEST(Gltf, WhatLiesBeyondTheFileIsRefused) {
    Making file = a_brick();
    file.json["bufferViews"][0]["byteOffset"] = 9007199254740991;
    EXPECT_HAS(file.refused(), "truncated");
    file = a_brick();
    file.json["bufferViews"][0]["byteStride"] = 0x7fffffff;
    EXPECT_HAS(file.refused(), "truncated");
    file = a_brick();
    file.primitive()["indices"] = file.accessor(std::vector<std::uint8_t>{0, 1, 8}, uint8, "SCALAR");
    EXPECT_HAS(file.refused(), "vertex 8 of 8");
}

}  // namespace
}  // namespace palpate
