#include "palpate/files/image_file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/base/isolated.h"

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#include <zlib.h>

#include <cstdio>
#include <cstring>
#include <limits>
#include <new>

namespace palpate {
namespace {

constexpr double most_pixels = 1 << 26;
constexpr std::size_t most_written = 4 * std::size_t(most_pixels) + 2 * sizeof(int);
constexpr double most_pixels_a_byte = 8 * 1032;  // of one bit each, with the best compression of a PNG

std::uint8_t byte(std::string_view bytes, std::size_t at) { return std::uint8_t(bytes[at]); }

// A big-endian number of `count` bytes.
std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | byte(bytes, at + i);
    return value;
}

// Whether its chunks, with their stated lengths and checksums, are complete to the last one. The decoder does
// not check this.
bool is_whole_png(std::string_view bytes) {
    bytes.remove_prefix(8);
    while (bytes.size() >= 12) {
        const std::size_t length = number(bytes, 0, 4);
        if (length > bytes.size() - 12) return false;
        const std::string_view chunk = bytes.substr(4, 4 + length);
        const auto sum = crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), uInt(chunk.size()));
        if (sum != number(bytes, 8 + length, 4)) return false;
        if (chunk.starts_with("IEND")) return true;
        bytes.remove_prefix(12 + length);
    }
    return false;
}

// Whether its segments are complete to the end marker; the decoder would fill in what is missing. Between
// them lies the data of scans, in which FF only precedes 00 or a restart marker.
bool is_whole_jpeg(std::string_view bytes) {
    for (std::size_t at = 2; at + 2 <= bytes.size();) {
        const std::uint32_t mark = byte(bytes, at) == 0xff ? byte(bytes, at + 1) : 0;
        if (mark == 0xd9) return true;
        const bool begins_segment = mark > 1 && mark != 0xff && (mark & 0xf8) != 0xd0;
        if (begins_segment && at + 4 > bytes.size()) return false;
        at += begins_segment ? 2 + number(bytes, at + 2, 2) : 1;
    }
    return false;
}

}  // namespace

Image read_image(const std::filesystem::path& path) { return parse_image(read_text(path), path.string()); }

Image parse_image(std::string_view bytes, const std::string& name) {
    auto refuse = [&](const std::string& what) { throw Error(what, name, "save it again as a PNG"); };
    const bool png = bytes.starts_with("\x89PNG\r\n\x1a\n"), jpeg = bytes.starts_with("\xff\xd8\xff");
    if (!png && !jpeg) refuse("neither a PNG nor a JPEG");
    const std::string damaged = fmt::format("a truncated or damaged {}", png ? "PNG" : "JPEG");
    if (!(png ? is_whole_png(bytes) : is_whole_jpeg(bytes))) refuse(damaged);
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max()))
        throw Error("a picture of more than 2 GB", name, "make it smaller");

    const Allowance allowance{.seconds = 15, .output = most_written};
    const Written written = isolated("stb", name, allowance, [&](std::FILE* to) {
        const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
        const int length = int(bytes.size());
        int size[2] = {};
        if (!stbi_info_from_memory(data, length, &size[0], &size[1], nullptr)) refuse(damaged);
        const double pixels = double(size[0]) * size[1];
        if (pixels > most_pixels)
            throw Error(fmt::format("a picture of {} x {} pixels", size[0], size[1]), name,
                        "make it smaller than 8192 x 8192");
        if (pixels > most_pixels_a_byte * double(bytes.size())) refuse(damaged);
        const stbi_uc* decoded = stbi_load_from_memory(data, length, &size[0], &size[1], nullptr, 4);
        if (!decoded && std::string_view(stbi_failure_reason()) == "outofmem") throw std::bad_alloc();
        if (!decoded) refuse(fmt::format("{} ({})", damaged, stbi_failure_reason()));
        std::fwrite(size, sizeof size, 1, to);
        std::fwrite(decoded, 4 * std::size_t(size[0]), std::size_t(size[1]), to);
    });

    int size[2] = {};
    const std::span<const char> got = written.bytes();
    if (got.size() >= sizeof size) std::memcpy(size, got.data(), sizeof size);
    if (size[0] <= 0 || size[1] <= 0 ||
        got.size() != sizeof size + 4 * std::size_t(size[0]) * std::size_t(size[1]))
        refuse(damaged);
    return {size[0], size[1], {got.begin() + sizeof size, got.end()}};
}

void write_png(const Image& image, const std::filesystem::path& path) {
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() != 4 * std::size_t(image.width) * std::size_t(image.height))
        throw Error("an image whose number of pixels differs from its width times height", path.string(),
                    "give it four bytes for each pixel");
    // write_file notices a short write.
    auto append = [](void* file, void* bytes, int count) {
        std::fwrite(bytes, 1, static_cast<std::size_t>(count), static_cast<std::FILE*>(file));
    };
    write_file(path, [&](std::FILE* file) {
        if (!stbi_write_png_to_func(append, file, image.width, image.height, 4, image.pixels.data(),
                                    4 * image.width))
            throw Error("cannot compress the image", path.string(), "make it smaller");
    });
}

}  // namespace palpate
