#include "palpate/files/formats/source.h"
#include "palpate/files/formats/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <istream>
#include <utility>

// NIfTI-1, NIfTI-2 and Analyze 7.5. A file may state the place of its voxels in three ways (a matrix, the
// sform; a quaternion, the qform; spacings alone). The first one that is present is used, as in nibabel, FSL
// and SPM, so a label volume lies on its image, whichever program wrote them.

namespace palpate {
namespace {

enum class Form { one_file, pair, analyze };

// The common content of the three kinds of header.
struct Header {
    Form form = Form::one_file;
    bool big_endian = false;
    std::array<double, 8> dim{}, pixdim{};
    int datatype = 0, qform = 0, sform = 0, units = 0;
    double size = 0, offset = 0;  // bytes
    double slope = 1, intercept = 0;
    dvec3 quaternion = dvec3(0), origin = dvec3(0);
    std::array<double, 12> matrix{};  // row by row
};

// The bytes of a header, in either byte order.
class Bytes {
 public:
    Bytes(const char* bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}
    template <class T>
    double at(std::size_t offset) const {
        char raw[sizeof(T)];
        std::memcpy(raw, bytes_ + offset, sizeof raw);
        if (swapped_) std::reverse(raw, raw + sizeof raw);
        return double(std::bit_cast<T>(raw));
    }
    template <class T, std::size_t N>
    void at(std::size_t offset, std::array<double, N>& numbers) const {
        for (std::size_t i = 0; i < N; ++i) numbers[i] = at<T>(offset + i * sizeof(T));
    }
    template <class T>
    dvec3 three(std::size_t offset) const {
        return {at<T>(offset), at<T>(offset + sizeof(T)), at<T>(offset + 2 * sizeof(T))};
    }

 private:
    const char* bytes_;
    bool swapped_;
};

constexpr std::size_t size_1 = 348, size_2 = 540;

bool is_big(bool swapped) { return (std::endian::native == std::endian::big) != swapped; }

Header header_1(const char* raw, bool swapped, Form form) {
    const Bytes bytes(raw, swapped);
    Header header{.form = form, .big_endian = is_big(swapped), .size = size_1};
    bytes.at<std::int16_t>(40, header.dim);
    bytes.at<float>(76, header.pixdim);
    header.datatype = int(bytes.at<std::int16_t>(70));
    header.offset = bytes.at<float>(108);
    header.slope = bytes.at<float>(112);  // in Analyze files SPM has its scale there
    if (form == Form::analyze) return header;
    header.intercept = bytes.at<float>(116);
    header.units = raw[123];
    header.qform = int(bytes.at<std::int16_t>(252));
    header.sform = int(bytes.at<std::int16_t>(254));
    header.quaternion = bytes.three<float>(256);
    header.origin = bytes.three<float>(268);
    bytes.at<float>(280, header.matrix);
    return header;
}

Header header_2(const char* raw, bool swapped, Form form) {
    const Bytes bytes(raw, swapped);
    Header header{.form = form, .big_endian = is_big(swapped), .size = size_2};
    bytes.at<std::int64_t>(16, header.dim);
    bytes.at<double>(104, header.pixdim);
    header.datatype = int(bytes.at<std::int16_t>(12));
    header.offset = bytes.at<std::int64_t>(168);
    header.slope = bytes.at<double>(176);
    header.intercept = bytes.at<double>(184);
    header.qform = int(bytes.at<std::int32_t>(344));
    header.sform = int(bytes.at<std::int32_t>(348));
    header.quaternion = bytes.three<double>(352);
    header.origin = bytes.three<double>(376);
    bytes.at<double>(400, header.matrix);
    header.units = int(bytes.at<std::int32_t>(500));
    return header;
}

Header read_header(std::istream& in, const std::filesystem::path& path) {
    std::array<char, size_2> raw{};
    in.read(raw.data(), size_1);
    std::int32_t size;
    std::memcpy(&size, raw.data(), sizeof size);
    const std::int32_t turned = std::int32_t(__builtin_bswap32(std::uint32_t(size)));
    const bool swapped = turned == int(size_1) || turned == int(size_2);
    if (swapped) size = turned;

    const bool two = size == int(size_2);
    if (!two && size != int(size_1)) refuse_start("NIfTI", path);
    if (two) in.read(raw.data() + size_1, size_2 - size_1);
    const std::string magic(raw.data() + (two ? 4 : 344), 3);
    const char version = two ? '2' : '1';
    const bool known = magic[0] == 'n' && magic[2] == version && (magic[1] == '+' || magic[1] == 'i');
    if (two && !known) refuse_start("NIfTI", path);
    if (!in) refuse("a truncated NIfTI header", path, "get the file again");
    if (known) {
        const Form form = magic[1] == '+' ? Form::one_file : Form::pair;
        return two ? header_2(raw.data(), swapped, form) : header_1(raw.data(), swapped, form);
    }
    if (lower_name(path).ends_with(".nii")) refuse_start("NIfTI", path);
    return header_1(raw.data(), swapped, Form::analyze);
}

// ---- where the voxels lie ----

// NIfTI's axes run right, forward and up; ours left, back and up.
const dmat3 to_ours(dvec3(-1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, 1));

// One of the ways in which a file states its place: its name and the resulting grid.
struct Stated {
    std::string name;
    std::optional<Grid> grid;
};

Stated by_matrix(const Header& header, ivec3 dims) {
    const auto& m = header.matrix;
    const dmat3 steps(dvec3(m[0], m[4], m[8]), dvec3(m[1], m[5], m[9]), dvec3(m[2], m[6], m[10]));
    return {fmt::format("sform (code {})", header.sform),
            grid_of(dims, to_ours * steps, to_ours * dvec3(m[3], m[7], m[11]))};
}

Stated by_quaternion(const Header& header, ivec3 dims, dvec3 spacing) {
    const dvec3 q = header.quaternion / std::max(1.0, glm::length(header.quaternion));
    const double a = std::sqrt(std::max(0.0, 1 - glm::dot(q, q))), b = q.x, c = q.y, d = q.z;
    const dmat3 turn(dvec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)),
                     dvec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)),
                     dvec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c));
    const double mirror = header.pixdim[0] < 0 ? -1 : 1;
    const dmat3 steps(turn[0] * spacing.x, turn[1] * spacing.y, turn[2] * spacing.z * mirror);
    return {fmt::format("qform (code {})", header.qform),
            grid_of(dims, to_ours * steps, to_ours * header.origin)};
}

// Without any statement: centred at the origin, with x to the left, as in nibabel.
Stated by_spacing(ivec3 dims, dvec3 spacing) {
    const dmat3 steps(dvec3(spacing.x, 0, 0), dvec3(0, -spacing.y, 0), dvec3(0, 0, spacing.z));
    return {"spacing alone", grid_of(dims, steps, -(steps * (dvec3(dims - 1) * 0.5)))};
}

// In metres; 0 where none is stated.
double unit_of(const Header& header) {
    const int code = header.units & 7;
    return code == 1 ? 1 : code == 2 ? 1e-3 : code == 3 ? 1e-6 : 0;
}

// The largest distance between corresponding corners of two grids.
double apart(const Grid& a, const Grid& b) {
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 voxel = dvec3(a.dims - 1) * dvec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        farthest = std::max(farthest, glm::distance(a.place(voxel), b.place(voxel)));
    }
    return farthest;
}

// The spacing, as the qform and files without a form need it.
dvec3 spacing_of(const Header& header, std::vector<std::string>& notes, const std::filesystem::path& path) {
    dvec3 spacing(header.pixdim[1], header.pixdim[2], header.pixdim[3]);
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(spacing[i])) refuse(fmt::format("voxels {} wide", spacing[i]), path);
        if (spacing[i] == 0) {
            notes.push_back(fmt::format("it states no spacing along {}: 1 is assumed", "xyz"[i]));
            spacing[i] = 1;
        } else if (spacing[i] < 0) {
            notes.push_back(
                fmt::format("its spacing along {} is {}: taken without the sign", "xyz"[i], spacing[i]));
            spacing[i] = -spacing[i];
        }
    }
    return spacing;
}

Grid place_of(const Header& header, ivec3 dims, std::vector<std::string>& notes,
              const std::filesystem::path& path) {
    std::vector<Stated> all;
    if (header.sform > 0) all.push_back(by_matrix(header, dims));
    std::vector<std::string> of_spacing;
    if (header.qform > 0) all.push_back(by_quaternion(header, dims, spacing_of(header, of_spacing, path)));
    if (all.empty()) {
        all.push_back(by_spacing(dims, spacing_of(header, of_spacing, path)));
        notes.push_back(
            header.form == Form::analyze
                ? "an Analyze file does not state its orientation: x is taken as left, y as forward, z "
                  "as up, and left and right may be swapped"
                : "it does not state its orientation (qform and sform code 0): x is taken as left, y as "
                  "forward, z as up");
    }
    const auto usable =
        std::find_if(all.begin(), all.end(), [](const Stated& s) { return s.grid.has_value(); });
    if (usable == all.end())
        refuse(
            "a " + all[0].name + " that is not finite, has no width, or whose axes are not at right angles",
            path, "resample it to axes at right angles");
    if (usable != all.begin())
        notes.push_back(
            fmt::format("its {} is not finite, has no width, or is not at right angles: the {} is taken",
                        all[0].name, usable->name));
    else if (all.size() == 2 && all[1].grid) {
        const dvec3 voxel = all[0].grid->spacing;
        const double distance = apart(*all[0].grid, *all[1].grid);
        if (distance > 0.1 * std::min({voxel.x, voxel.y, voxel.z}))
            notes.push_back(fmt::format(
                "it states two placements, up to {:.3g} mm apart: the {} is taken, not the {}",
                distance * 1000 * (unit_of(header) > 0 ? unit_of(header) : 1e-3), all[0].name, all[1].name));
    }
    if (!usable->name.starts_with("sform")) notes.insert(notes.end(), of_spacing.begin(), of_spacing.end());
    return *usable->grid;
}

// ---- the voxels ----

std::optional<Number> nifti_number(int datatype) {
    constexpr std::pair<int, Number> kinds[] = {
        {2, Number::uint8},    {256, Number::int8},   {4, Number::int16},    {512, Number::uint16},
        {8, Number::int32},    {768, Number::uint32}, {16, Number::float32}, {1024, Number::int64},
        {64, Number::float64}, {1280, Number::uint64}};
    for (auto [kind, number] : kinds)
        if (kind == datatype) return number;
    return std::nullopt;
}

[[noreturn]] void refuse_type(int datatype, const std::filesystem::path& path) {
    const bool colours = datatype == 128 || datatype == 2304, complex = datatype == 32 || datatype >= 1792;
    refuse(colours   ? "colours (RGB)"
           : complex ? "complex numbers"
                     : fmt::format("voxels of type {}, which is not read,", datatype),
           path, "convert it to one real number a voxel");
}

ivec3 sizes_of(const Header& header, std::vector<std::string>& notes, const std::filesystem::path& path) {
    const double count = header.dim[0];
    if (!(count >= 3 && count <= 7))
        refuse(fmt::format("{} dimensions instead of three", count), path, "give a volume");
    const ivec3 dims = checked_sizes({header.dim[1], header.dim[2], header.dim[3]}, path);
    for (std::size_t i = 5; i <= std::size_t(count); ++i)
        if (header.dim[i] > 1)
            refuse(fmt::format("{} numbers a voxel", header.dim[i]), path, "split it and give one of them");
    if (count >= 4 && header.dim[4] > 1)
        notes.push_back(fmt::format("{} time points: the first is taken", header.dim[4]));
    return dims;
}

Layout layout_of(const Header& header, std::size_t voxels, std::vector<std::string>& notes,
                 const std::filesystem::path& path) {
    const auto number = nifti_number(header.datatype);
    if (!number) refuse_type(header.datatype, path);
    Layout layout{.number = *number, .big_endian = header.big_endian, .voxels = voxels};
    if (!(header.offset >= 0 && header.offset < 1e15)) refuse("voxels at an invalid offset", path);
    layout.skipped_bytes = std::int64_t(header.offset);
    // A slope of 0 means none.
    if (std::isfinite(header.slope) && header.slope != 0) {
        layout.slope = header.slope;
        if (std::isfinite(header.intercept)) layout.intercept = header.intercept;
        if (header.form == Form::analyze && header.slope != 1)
            notes.push_back(fmt::format("its values are scaled by {}, as SPM's are", header.slope));
    }
    return layout;
}

// How many bytes after the header the voxels of one file begin. If the stated offset is within the header,
// they begin right after it, as in nifti_clib.
std::int64_t behind_header(const Header& header, std::int64_t offset, std::vector<std::string>& notes) {
    const auto size = std::int64_t(header.size);
    if (offset < size)
        notes.push_back(fmt::format(
            "its voxels would begin at byte {}, within its header: they are taken from byte {} on", offset,
            size));
    return std::max<std::int64_t>(offset - size, 0);
}

// The other file of a pair: the same name with another extension, with or without a final .gz.
std::filesystem::path partner(const std::filesystem::path& path, std::string extension) {
    std::filesystem::path stem = path;
    if (lower_name(stem).ends_with(".gz")) stem.replace_extension();
    for (const bool large : {false, true}) {
        if (large)
            for (char& c : extension) c = char(std::toupper(static_cast<unsigned char>(c)));
        for (const char* packed : {"", ".gz"}) {
            std::filesystem::path other = stem.replace_extension(extension);
            other += packed;
            if (std::filesystem::exists(other)) return other;
        }
    }
    return {};
}

}  // namespace

Reading read_nifti(const std::filesystem::path& path) {
    const std::string name = lower_name(path);
    const bool image = name.ends_with(".img") || name.ends_with(".img.gz");
    const std::filesystem::path headed = image ? partner(path, ".hdr") : path;
    if (headed.empty()) refuse("no header (.hdr) beside it for the voxels", path, "put it there");
    const auto in = open_file(headed);
    Header header;
    try {
        header = read_header(*in, headed);
    } catch (const std::ios_base::failure&) {
        refuse("a truncated or damaged gzip", headed, "get the file again");
    }

    Reading reading;
    reading.grid.dims = sizes_of(header, reading.notes, headed);
    reading.grid = place_of(header, reading.grid.dims, reading.notes, headed);
    reading.unit = unit_of(header);

    Layout layout = layout_of(header, reading.grid.count(), reading.notes, headed);
    if (header.form == Form::one_file) {
        layout.skipped_bytes = behind_header(header, layout.skipped_bytes, reading.notes);
        reading.values = read_voxels(*in, layout, headed);
    } else {
        const std::filesystem::path data = image ? path : partner(path, ".img");
        if (data.empty()) refuse("no voxels (.img) beside it for the header", path, "put them there");
        reading.values = read_voxels(*open_file(data), layout, data);
    }
    return reading;
}

}  // namespace palpate
