#pragma once
// glTF in the making, and what a box must be that was read.
#include "palpate/files/read.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace palpate {

using Json = nlohmann::json;

inline constexpr int int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126;

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

inline const Mesh brick = box(vec3(0), vec3(2, 3, 5));

inline Making a_brick(float scale = 1) {
    Making file;
    std::vector<vec3> corners = brick.positions;
    for (vec3& p : corners) p *= scale;
    file.primitive()["attributes"]["POSITION"] = file.vectors(corners);
    file.primitive()["indices"] = file.triangles(brick);
    return file;
}

inline void expect_box(const Mesh& mesh, vec3 low, vec3 high, double of_volume, float error = 1e-5f) {
    const Bounds around = bounds(mesh);
    EXPECT_LE(glm::distance(around.low, low), error)
        << around.low.x << ' ' << around.low.y << ' ' << around.low.z;
    EXPECT_LE(glm::distance(around.high, high), error)
        << around.high.x << ' ' << around.high.y << ' ' << around.high.z;
    EXPECT_LE(std::abs(volume(mesh) - of_volume), 20 * error * of_volume);
}

}  // namespace palpate
