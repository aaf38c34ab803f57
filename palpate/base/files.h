#pragma once
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace palpate {

/// The whole text of a file. Throws Error if it cannot be read.
std::string read_text(const std::filesystem::path& path);

/// Writes a file whole or not at all: `write` fills a temporary file beside it, which takes the final name
/// only when everything has reached the disk. If `write` throws, or the disk is full, the temporary file is
/// removed, an older file under the final name stays as it was, and Error is thrown.
/// A link is followed; a pipe or a device is written to directly.
void write_file(const std::filesystem::path& path, const std::function<void(std::FILE*)>& write);

/// The name of the temporary file that becomes `path`: beside it, because a rename across disks would be a
/// copy.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// write_file for a text that is ready.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Creates a folder and its parents where they are missing. Throws Error if it cannot.
void make_folder(const std::filesystem::path& folder);

}  // namespace palpate
