#pragma once
// What the tests of readers share.
#include "palpate/base/error.h"
#include "palpate/files/read.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace palpate {

// What the Error says, which must name the file; empty if none was thrown.
inline std::string refusal(const std::filesystem::path& path, const std::function<void()>& act) {
    const std::string said = refusal(act);
    EXPECT_TRUE(said.empty() || said.find(path.string() + "; ") != said.npos) << said;
    return said;
}

// Without write_text's wait for the disk: these tests write thousands of files.
inline void put(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// Of a file with these bytes and a name of this extension; empty if it is read.
inline std::string parse_error(const std::string& name, std::string_view bytes) {
    return refusal(name, [&] { parse_mesh(bytes, name, Units::metres); });
}

// Reading must end in a sound mesh or in an Error, whatever the bytes.
inline void expect_sound_or_error(const std::string& name, std::string_view bytes) {
    try {
        const Mesh mesh = parse_mesh(bytes, name, Units::metres);
        EXPECT_FALSE(mesh.triangles.empty());
        for (vec3 p : mesh.positions)
            EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        for (uvec3 t : mesh.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
        EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    } catch (const Error&) {}
}

#define EXPECT_HAS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

}  // namespace palpate
