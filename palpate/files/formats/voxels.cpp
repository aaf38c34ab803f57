#include "palpate/files/formats/voxels.h"

#include "palpate/files/formats/source.h"

#include <boost/iostreams/device/file.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <istream>

namespace palpate {
namespace {

namespace io = boost::iostreams;
using Filtered = io::filtering_istream;

constexpr std::size_t block_size = 1 << 16;

std::array<unsigned char, 6> first_bytes(const std::filesystem::path& path) {
    std::array<unsigned char, 6> bytes{};
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    return bytes;
}

bool is_gzip(const std::filesystem::path& path) {
    const auto bytes = first_bytes(path);
    return bytes[0] == 0x1f && bytes[1] == 0x8b && bytes[2] == 8;
}

// A stream that decompresses as it is read. Its exceptions are passed on, so that they can be distinguished.
std::unique_ptr<Filtered> unpacked(std::istream& in, Packing packing, const std::filesystem::path& file) {
    auto out = std::make_unique<Filtered>();
    const int first = in.peek();
    if (packing == Packing::bzip2) {
        if (first != 'B') refuse("voxels that are not bzip2 although the header says so,", file);
        out->push(io::bzip2_decompressor());
    } else if (first == 0x1f) {
        out->push(io::gzip_decompressor());
    } else if ((first & 0x0f) == 8) {
        out->push(io::zlib_decompressor());
    } else {
        refuse("voxels that are not gzip although the header says so,", file);
    }
    out->push(in);
    out->exceptions(std::ios::badbit);
    return out;
}

// Reads on to the checksum at the end of a compressed file, unless it is far away.
void read_to_checksum(std::istream& in) {
    std::vector<char> rest(block_size);
    try {
        in.read(rest.data(), std::streamsize(rest.size()));
    } catch (const io::gzip_error& error) {
        if (error.error() != io::gzip::bad_header) throw;  // other data follow a complete gzip
    }
}

void skip(std::istream& in, std::int64_t bytes) {
    std::array<char, 4096> gone;
    while (bytes > 0 && in.read(gone.data(), std::min<std::streamsize>(bytes, gone.size())))
        bytes -= in.gcount();
}

void skip_lines(std::istream& in, std::int64_t lines) {
    for (; lines > 0 && in; --lines) in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
}

// Skips all but the last `bytes`.
void skip_to_last(std::istream& in, double bytes, const std::filesystem::path& file) {
    in.seekg(0, std::ios::end);
    const double all = double(in.tellg());
    if (!in || all < 0) refuse("voxels at the end of a compressed file", file, "decompress it first");
    if (bytes > all) refuse_truncated(all, bytes, "bytes", file);
    in.seekg(std::streamoff(all - bytes));
}

// Decodes pairs of hexadecimal digits; returns the number of bytes.
std::size_t read_hex(std::istream& in, char* to, std::size_t most, const std::filesystem::path& file) {
    std::size_t digits = 0;
    for (char c; digits < 2 * most && in.get(c);) {
        if (std::isspace(static_cast<unsigned char>(c))) continue;
        const char* all = "0123456789abcdef";
        const char* found = std::strchr(all, std::tolower(static_cast<unsigned char>(c)));
        if (!found || c == '\0') refuse("a character that is not a hexadecimal digit", file);
        const auto value = char(found - all);
        to[digits / 2] = digits % 2 == 0 ? char(value << 4) : char(to[digits / 2] | value);
        ++digits;
    }
    return digits / 2;
}

}  // namespace

std::unique_ptr<std::istream> open_packed(const std::filesystem::path& path) {
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
        refuse("not a regular file", path, "name a file");
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*file) refuse("cannot open", path, "check the name and that it may be read");
    return file;
}

std::unique_ptr<std::istream> open_file(const std::filesystem::path& path) {
    auto file = open_packed(path);
    if (!is_gzip(path)) return file;
    auto out = std::make_unique<Filtered>();
    out->push(io::gzip_decompressor());
    out->push(io::file_source(path.string(), std::ios::binary));
    out->exceptions(std::ios::badbit);
    return out;
}

void refuse_start(std::string_view format, const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::file_size(path, unreadable) == 0)
        refuse(fmt::format("no {} header (the file is empty)", format), path, "get the file again");
    const auto bytes = first_bytes(path);
    const std::string start(bytes.begin(), bytes.end());
    for (const auto& [mark, packing] : {std::pair("PK\3\4", "zip"),
                                        {"\xfd"
                                         "7zXZ",
                                         "xz"},
                                        {"BZh", "bzip2"},
                                        {"7z\xbc\xaf", "7z"},
                                        {"\x28\xb5\x2f\xfd", "zstd"}})
        if (start.starts_with(mark)) refuse(fmt::format("an archive ({})", packing), path, "unpack it first");
    refuse(fmt::format("no {} header", format), path, "give a file of the format that its name says");
}

std::size_t bytes_of(Number kind) {
    constexpr std::size_t bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return bytes[std::size_t(kind)];
}

// How many numbers there are in one file, kept or not.
std::size_t Voxels::in_each_file() const { return layout_.voxels * layout_.every / layout_.files; }

void Voxels::take(std::istream& file_in, const std::filesystem::path& file) try {
    skip_lines(file_in, layout_.skipped_lines);
    std::unique_ptr<Filtered> packed;
    if (layout_.packing == Packing::gzip || layout_.packing == Packing::bzip2)
        packed = unpacked(file_in, layout_.packing, file);
    std::istream& in = packed ? *packed : file_in;
    if (layout_.skipped_bytes == -1)
        skip_to_last(in, double(in_each_file()) * double(bytes_of(layout_.number)), file);
    else
        skip(in, layout_.skipped_bytes);
    if (layout_.packing == Packing::text)
        take_text(in, file);
    else
        take_binary(in, file);
    if (dynamic_cast<Filtered*>(&in)) read_to_checksum(in);
} catch (const std::ios_base::failure&) {  // boost's errors of gzip, zlib and bzip2
    refuse(layout_.packing == Packing::bzip2 ? "a truncated or damaged bzip2" : "a truncated or damaged gzip",
           file, "get the file again");
}

void Voxels::take_binary(std::istream& in, const std::filesystem::path& file) {
    const std::size_t size = bytes_of(layout_.number);
    std::vector<char> block(block_size);
    std::size_t there = 0;
    for (const std::size_t promised = in_each_file() * size; there < promised && !full();) {
        const std::size_t wanted = std::min(block.size(), promised - there);
        std::size_t count;
        if (layout_.packing == Packing::hex) {
            count = read_hex(in, block.data(), wanted, file);
        } else {
            in.read(block.data(), std::streamsize(wanted));
            count = std::size_t(in.gcount());
        }
        there += count;
        if (count < wanted) refuse_truncated(double(there), double(promised), "bytes", file);
        keep(block, count / size);
    }
}

void Voxels::take_text(std::istream& in, const std::filesystem::path& file) {
    const std::size_t promised = in_each_file();
    std::string word;
    for (std::size_t there = 0; there < promised && !full(); ++there) {
        if (!(in >> std::setw(64) >> word))
            refuse_truncated(double(there), double(promised), "numbers", file);
        const auto number = parse_number(word);
        if (!number) refuse(in_quotes(word) + " instead of a number", file);
        make_room(1);
        if (seen_++ / layout_.run % layout_.every == 0)
            values_.push_back(float(*number * layout_.slope + layout_.intercept));
    }
}

// Grows by at most half of the present size, so that nothing is allocated for what is not there.
void Voxels::make_room(std::size_t more) {
    const std::size_t needed = values_.size() + more;
    if (needed > values_.capacity()) values_.reserve(std::min(layout_.voxels, needed + needed / 2));
}

template <class T>
void Voxels::keep(const char* raw, std::size_t count) {
    const bool scaled = layout_.slope != 1 || layout_.intercept != 0;
    for (std::size_t i = 0; i < count; ++i, ++seen_) {
        if (layout_.every > 1 && seen_ / layout_.run % layout_.every != 0) continue;
        char bytes[sizeof(T)];
        std::memcpy(bytes, raw + i * sizeof(T), sizeof(T));
        if (layout_.big_endian) std::reverse(bytes, bytes + sizeof(T));
        const T number = std::bit_cast<T>(bytes);
        values_.push_back(scaled ? float(double(number) * layout_.slope + layout_.intercept) : float(number));
    }
}

void Voxels::keep(const std::vector<char>& block, std::size_t count) {
    make_room(count);
    switch (layout_.number) {
        case Number::int8:
            return keep<std::int8_t>(block.data(), count);
        case Number::uint8:
            return keep<std::uint8_t>(block.data(), count);
        case Number::int16:
            return keep<std::int16_t>(block.data(), count);
        case Number::uint16:
            return keep<std::uint16_t>(block.data(), count);
        case Number::int32:
            return keep<std::int32_t>(block.data(), count);
        case Number::uint32:
            return keep<std::uint32_t>(block.data(), count);
        case Number::int64:
            return keep<std::int64_t>(block.data(), count);
        case Number::uint64:
            return keep<std::uint64_t>(block.data(), count);
        case Number::float32:
            return keep<float>(block.data(), count);
        case Number::float64:
            return keep<double>(block.data(), count);
    }
}

std::vector<float> read_voxels(std::istream& in, const Layout& layout, const std::filesystem::path& file) {
    Voxels voxels(layout);
    voxels.take(in, file);
    return std::move(voxels).values();
}

std::vector<float> read_voxels(const std::vector<std::filesystem::path>& files, Layout layout,
                               const std::filesystem::path& path) {
    layout.files = files.size();
    if (layout.voxels * layout.every % files.size() != 0)
        refuse(fmt::format("{} files, which cannot share {} voxels evenly,", files.size(),
                           layout.voxels * layout.every),
               path);
    const bool packed = layout.packing == Packing::gzip || layout.packing == Packing::bzip2;
    Voxels voxels(layout);
    for (const auto& file : files)
        if (!voxels.full()) {
            if (!std::filesystem::exists(file))
                refuse("no file " + in_quotes(file.string(), 200) + ", which is named", path,
                       "put it there, or correct the name");
            voxels.take(packed ? *open_packed(file) : *open_file(file), file);
        }
    return std::move(voxels).values();
}

}  // namespace palpate
