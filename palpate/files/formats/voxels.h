#pragma once
#include "palpate/files/formats/volumes.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <vector>

namespace palpate {

/// Opens an ordinary file. A gzip is decompressed, whatever its name.
std::unique_ptr<std::istream> open_file(const std::filesystem::path& path);

/// The same, but without decompression.
std::unique_ptr<std::istream> open_packed(const std::filesystem::path& path);

/// Throws an Error that a file does not begin like one of `format`, or that it is an archive.
[[noreturn]] void refuse_start(std::string_view format, const std::filesystem::path& path);

enum class Number { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
std::size_t bytes_of(Number kind);

enum class Packing { none, text, hex, gzip, bzip2 };

/// How the numbers of a volume are encoded.
struct Layout {
    Number number = Number::uint8;
    bool big_endian = false;
    Packing packing = Packing::none;
    std::size_t voxels = 0;  // how many are kept
    // For a fourth axis: the first of every `every` runs of `run` numbers is kept.
    std::size_t run = 1, every = 1;
    double slope = 1, intercept = 0;
    std::int64_t skipped_lines = 0;  // before unpacking
    std::int64_t skipped_bytes = 0;  // after it; -1: the numbers are a file's last
    std::size_t files = 1;           // over which the numbers are spread evenly
};

/// Reads the voxels of a volume from one stream or several.
class Voxels {
 public:
    explicit Voxels(const Layout& layout) : layout_(layout) {}

    /// Reads one of the files. Throws an Error with `file` in it if that is damaged or too short.
    void take(std::istream& in, const std::filesystem::path& file);
    bool full() const { return values_.size() == layout_.voxels; }
    std::vector<float> values() && { return std::move(values_); }

 private:
    void take_binary(std::istream& in, const std::filesystem::path& file);
    void take_text(std::istream& in, const std::filesystem::path& file);
    template <class T>
    void keep(const char* raw, std::size_t count);
    void keep(const std::vector<char>& block, std::size_t count);
    void make_room(std::size_t more);
    std::size_t in_each_file() const;

    Layout layout_;
    std::size_t seen_ = 0;  // numbers, kept or not
    std::vector<float> values_;
};

/// Reads all of them from one stream, or from separate files in order. `path`: the header's file.
std::vector<float> read_voxels(std::istream& in, const Layout& layout, const std::filesystem::path& path);
std::vector<float> read_voxels(const std::vector<std::filesystem::path>& files, Layout layout,
                               const std::filesystem::path& path);

}  // namespace palpate
