// Any bytes as a PNG or a JPEG: an Error, or a complete image. A PNG's checksums are corrected first,
// since no fuzzer would guess them.
#include "palpate/base/error.h"
#include "palpate/files/image_file.h"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::uint8_t(bytes[at + i]);
    return value;
}

void correct_checksums(std::string& png) {
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::size_t length = big_endian(png, at), end = at + 8 + length;
        if (end + 4 > png.size()) return;
        const auto sum = crc32(0, reinterpret_cast<const Bytef*>(&png[at + 4]), uInt(4 + length));
        for (std::size_t i = 0; i < 4; ++i) png[end + i] = char(sum >> (24 - 8 * i));
        at = end + 4;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    correct_checksums(bytes);
    try {
        const palpate::Image image = palpate::parse_image(bytes, "fuzz");
        if (image.width <= 0 || image.height <= 0) std::abort();
        if (image.pixels.size() != 4 * std::size_t(image.width) * std::size_t(image.height)) std::abort();
    } catch (const palpate::Error& error) {
        if (std::string_view(error.what()).find_first_of("\n\r") != std::string_view::npos) std::abort();
    }
    return 0;
}
