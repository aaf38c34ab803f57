#pragma once
// A reader of glTF that believes nothing: each rule that it checks is one of the format's.
#include "palpate/base/files.h"
#include "palpate/base/vectors.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace palpate {

/// What lies at a place of a file.
template <class T>
T at(const std::string& bytes, std::size_t offset) {
    T value{};
    EXPECT_LE(offset + sizeof value, bytes.size());
    if (offset + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

struct Gltf {
    nlohmann::json json;
    std::string binary;

    /// The numbers of an accessor, which lies where it may, is as long as it says, and within its limits.
    template <class T>
    std::vector<T> numbers(std::size_t accessor) const {
        const auto& a = json["accessors"][accessor];
        const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        EXPECT_EQ(a["componentType"], (std::is_integral_v<T> ? 5125 : 5126));
        EXPECT_EQ(a["type"], sizeof(T) == 12 ? "VEC3" : "SCALAR");
        const std::size_t count = a["count"], offset = a["byteOffset"], begin = view["byteOffset"];
        const std::size_t length = view["byteLength"];
        EXPECT_GE(count, 1u);
        EXPECT_EQ(offset % 4, 0u);
        EXPECT_EQ(begin % 4, 0u);
        EXPECT_EQ(view.value("byteStride", sizeof(T)), sizeof(T));
        EXPECT_LE(offset + count * sizeof(T), length);
        EXPECT_LE(begin + length, binary.size());
        std::vector<T> values;
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(at<T>(binary, begin + offset + i * sizeof(T)));
        return values;
    }

    /// The same for positions, which must say their box exactly.
    std::vector<vec3> positions(std::size_t accessor) const {
        const std::vector<vec3> values = numbers<vec3>(accessor);
        const auto& a = json["accessors"][accessor];
        vec3 low = values[0], high = low;
        for (vec3 v : values) low = glm::min(low, v), high = glm::max(high, v);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(a["min"][k].get<float>(), low[k]);
            EXPECT_EQ(a["max"][k].get<float>(), high[k]);
        }
        return values;
    }

    const nlohmann::json& primitive() const { return json["meshes"][0]["primitives"][0]; }
};

inline Gltf read_glb(const std::filesystem::path& path) {
    const std::string file = read_text(path);
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(at<std::uint32_t>(file, 4), 2u);
    EXPECT_EQ(at<std::uint32_t>(file, 8), file.size());
    const auto json = at<std::uint32_t>(file, 12), binary = at<std::uint32_t>(file, 20 + json);
    EXPECT_EQ(json % 4, 0u);
    EXPECT_EQ(binary % 4, 0u);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    EXPECT_EQ(file.substr(24 + json, 4), std::string("BIN\0", 4));
    EXPECT_EQ(28 + json + binary, file.size());
    Gltf gltf{nlohmann::json::parse(file.substr(20, json)), file.substr(28 + json)};
    EXPECT_EQ(gltf.json["asset"]["version"], "2.0");
    EXPECT_EQ(gltf.json["buffers"][0]["byteLength"], binary);
    return gltf;
}

}  // namespace palpate
