// How the numbers of a glTF file lie in its bytes, plain, packed and damaged.
#include "tests/files/gltf_making.h"
#include "tests/scratch.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cstring>
#include <random>

namespace palpate {
namespace {

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
    EXPECT_HAS(notes[0], "left out 1 corner beyond the last whole triangle");
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
    EXPECT_HAS(file.refused(), "a stride of 10 in meshopt's compression, which is not a multiple of 4");
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
    EXPECT_HAS(file.refused(), "a Draco mesh without attribute 7");
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
    EXPECT_HAS(file.refused(), "a cycle of nodes");
    file.json["nodes"] = {{{"mesh", 0}, {"children", {2}}}, {{"children", {2}}}, Json::object()};
    EXPECT_HAS(file.refused(), "has two parents");
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
