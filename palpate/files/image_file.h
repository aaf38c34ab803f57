#pragma once
#include "palpate/mesh/image.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

/// Reads a PNG or a JPEG, by its first bytes. Greyscale is converted to colours and 16 bits to 8; alpha is
/// 255 if the file has none. The decoder runs in a process of its own, with limits on time and memory. Throws
/// Error if the file is missing, truncated, damaged (a PNG's checksums are checked), neither of the two, or
/// claims more than 2^26 pixels or more than a file of its length can hold.
Image read_image(const std::filesystem::path& path);

/// The same for the bytes of a file in memory; `name` is for messages.
Image parse_image(std::string_view bytes, const std::string& name);

/// Throws Error if the file cannot be written.
void write_png(const Image& image, const std::filesystem::path& path);

}  // namespace palpate
