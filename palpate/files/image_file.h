#pragma once
#include "palpate/mesh/image.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

/// Reads a PNG or a JPEG, whichever its first bytes say it is; greys become colours, 16 bits 8, and alpha is
/// 255 where the file has none. The decoder works in a process of its own, with bounds on time and memory.
/// Throws Error if the file is missing, truncated, damaged (a PNG's checksums are checked), neither of the
/// two, or says that it is larger than 2^26 pixels or than a file of its length can be.
Image read_image(const std::filesystem::path& path);

/// The same for a file's bytes that are in memory already; `name` stands in messages.
Image parse_image(std::string_view bytes, const std::string& name);

/// Throws Error if the file cannot be written.
void write_png(const Image& image, const std::filesystem::path& path);

}  // namespace palpate
