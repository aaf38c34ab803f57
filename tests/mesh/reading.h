#pragma once
// What the tests of readers share.
#include "palpate/base/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace palpate {

// The message of the one Error that `f` must throw: a single line that names the file.
template <class F>
inline std::string error_of(const std::filesystem::path& path, F f) {
    try {
        f();
    } catch (const Error& error) {
        const std::string line = error.what();
        EXPECT_EQ(line.find('\n'), std::string::npos);
        EXPECT_NE(line.find(path.string() + "; "), std::string::npos) << line;
        return line;
    }
    return "no error";
}

// Without write_text's wait for the disk: these tests write thousands of files.
inline void put(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

#define EXPECT_HAS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

}  // namespace palpate
