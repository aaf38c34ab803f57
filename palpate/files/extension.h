#pragma once
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace palpate {

/// The extension by which a file's format is chosen, with the dot, in small letters: ".ply" for "Heart.PLY".
inline std::string extension(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

}  // namespace palpate
