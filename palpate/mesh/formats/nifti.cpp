#include "palpate/mesh/formats/volumes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate {
namespace {

// The 348 bytes that every NIfTI-1 file begins with; its numbers may be in either byte order.
struct Header {
    static constexpr std::size_t size = 348;
    std::array<char, size> bytes{};

    template <class T>
    T load(const char* from) const {
        char raw[sizeof(T)];
        std::memcpy(raw, from, sizeof raw);
        if (swapped()) std::reverse(raw, raw + sizeof raw);
        return std::bit_cast<T>(raw);
    }
    template <class T>
    T at(std::size_t offset) const {
        return load<T>(&bytes[offset]);
    }
    // It begins with its own size, or with that of NIfTI-2.
    int begins_with() const { return at<std::int32_t>(0); }
    bool swapped() const {
        std::int32_t raw;
        std::memcpy(&raw, bytes.data(), sizeof raw);
        return raw != 348 && raw != 540;
    }
    int dim(int i) const { return at<std::int16_t>(40 + 2 * i); }
    int datatype() const { return at<std::int16_t>(70); }
    float spacing(int i) const { return at<float>(76 + 4 * i); }
    float data_offset() const { return std::max(at<float>(108), float(size)); }
    // How many millimetres its unit of length is.
    double millimetres() const {
        const int unit = bytes[123] & 7;
        return unit == 1 ? 1000 : unit == 3 ? 0.001 : 1;
    }
    double voxels() const { return double(dim(1)) * dim(2) * dim(3); }
    bool has_quaternion() const { return at<std::int16_t>(252) > 0; }
    bool has_matrix() const { return at<std::int16_t>(254) > 0; }
    std::string_view magic() const { return {&bytes[344], 3}; }
};

// Bytes of a voxel of the NIfTI data types that are one real number (integers of 8 to 64 bits with and
// without a sign, float and double); 0 for all others.
std::size_t voxel_bytes(int datatype) {
    constexpr std::pair<int, std::size_t> kinds[] = {{2, 1},   {256, 1}, {4, 2},    {512, 2},  {8, 4},
                                                     {768, 4}, {16, 4},  {1024, 8}, {1280, 8}, {64, 8}};
    for (auto [kind, bytes] : kinds)
        if (kind == datatype) return bytes;
    return 0;
}

// False for what no scanner writes. Where a matrix is not finite, ITK ends the whole program; where it is
// subnormal, it complains aloud.
bool sensible(float value) { return std::abs(value) < 1e9f && std::fpclassify(value) != FP_SUBNORMAL; }

void check_format(const Header& header, const std::filesystem::path& path) {
    if (header.begins_with() == 540) refuse("NIfTI-2", path, "convert it to NIfTI-1");
    if (header.begins_with() != int(Header::size)) refuse("no NIfTI-1 header", path);
    if (header.magic() == "ni1")
        refuse("a NIfTI header apart from its data", path, "join them to one .nii file");
    if (header.magic() != "n+1") refuse("no NIfTI-1 header", path);
}

void check_dimensions(const Header& header, const std::filesystem::path& path) {
    const int dims = header.dim(0);
    if (dims < 3 || dims > 7)
        refuse(fmt::format("{} dimensions instead of three", dims), path, "give a volume");
    check_sizes({double(header.dim(1)), double(header.dim(2)), double(header.dim(3))}, path);
    if (dims >= 4 && header.dim(4) > 1)
        refuse(fmt::format("{} time points", header.dim(4)), path, "split it and give one of them");
    for (int i = 5; i <= dims; ++i)
        if (header.dim(i) > 1) refuse("several values a voxel", path, "split it and give one of them");
}

void check_geometry(const Header& header, const std::filesystem::path& path) {
    for (int i = 1; i <= 3; ++i)
        if (!(header.spacing(i) > 1e-9f && sensible(header.spacing(i))))
            refuse(fmt::format("voxels {} wide", header.spacing(i)), path);
    const std::size_t from = header.has_quaternion() ? 256 : 280, to = header.has_matrix() ? 328 : 280;
    for (std::size_t offset = from; offset < to; offset += 4)
        if (!sensible(header.at<float>(offset))) refuse("an orientation that is not finite", path);
}

void check_data(const Header& header, const std::filesystem::path& path) {
    if (!sensible(header.data_offset())) refuse("voxels that begin nowhere", path);
    if (voxel_bytes(header.datatype()) == 0)
        refuse(fmt::format("voxels of NIfTI's type {}, which are not real numbers", header.datatype()), path,
               "convert them to numbers");
}

// A gzip file as it comes out, or a plain file as it is.
class Stream {
 public:
    explicit Stream(const std::filesystem::path& path) : path_(path) {
        file_.reset(gzopen(path.c_str(), "rb"));
        if (!file_) refuse("cannot open", path, "check the name and that it may be read");
    }
    // How many bytes could be read: less than `most` only at the end of the file.
    std::size_t read(char* to, std::size_t most) {
        const int count = gzread(file_.get(), to, unsigned(most));
        int error;
        gzerror(file_.get(), &error);
        if (count < 0 || error != Z_OK) refuse("a truncated or damaged gzip", path_, "get the file again");
        return std::size_t(count);
    }

 private:
    struct Close {
        void operator()(gzFile file) const { gzclose(file); }
    };
    const std::filesystem::path& path_;
    std::unique_ptr<gzFile_s, Close> file_;
};

Header read_header(Stream& stream, const std::filesystem::path& path) {
    Header header;
    if (stream.read(header.bytes.data(), Header::size) < Header::size) refuse("no NIfTI-1 header", path);
    check_format(header, path);
    check_dimensions(header, path);
    check_geometry(header, path);
    check_data(header, path);
    return header;
}

// In the file's own byte order and kind; ITK would turn what is not finite into zeros.
template <class T>
void check_finite(const Header& header, const std::vector<char>& block, std::size_t bytes,
                  std::uint64_t first, const std::filesystem::path& path) {
    for (std::size_t i = 0; i + sizeof(T) <= bytes; i += sizeof(T))
        if (!std::isfinite(header.load<T>(&block[i])))
            refuse(fmt::format("voxel {} is not finite", (first + i) / sizeof(T)), path);
}

// Reads the voxels once, in small blocks, and on to the end of the file, where a gzip has its checksum.
void check_voxels(Stream& stream, const Header& header, const std::filesystem::path& path) {
    const double offset = header.data_offset();
    const double promised = header.voxels() * double(voxel_bytes(header.datatype()));
    std::vector<char> block(1 << 16);
    for (double gap = offset - double(Header::size); gap > 0;) {
        const auto count = stream.read(block.data(), std::size_t(std::min(gap, double(block.size()))));
        if (count == 0) break;
        gap -= double(count);
    }
    std::uint64_t total = 0;
    while (const std::size_t count = stream.read(block.data(), block.size())) {
        const auto voxels = std::size_t(std::min(double(count), std::max(promised - double(total), 0.0)));
        if (header.datatype() == 16) check_finite<float>(header, block, voxels, total, path);
        if (header.datatype() == 64) check_finite<double>(header, block, voxels, total, path);
        total += count;
    }
    if (!(promised <= double(total))) refuse_truncated(double(total), promised, path);
}

}  // namespace

Found look_through_nifti(const std::filesystem::path& path) {
    Stream stream(path);
    const Header header = read_header(stream, path);
    check_voxels(stream, header, path);
    return {.bytes = sizeof(double) * header.voxels(), .origin_scale = header.millimetres()};
}

}  // namespace palpate
