#pragma once
#include "palpate/base/vectors.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

// One reader for each format, hardened against untrusted files. They allocate only for what is there, never
// for what a file claims.

/// 1024³: four gigabytes of values.
constexpr double most_voxels = 1 << 30;

[[noreturn]] void refuse(std::string_view what, const std::filesystem::path& path,
                         std::string_view remedy = "export it again");

/// A file's name, without its folders, in small letters.
std::string lower_name(const std::filesystem::path& path);
std::string lower_case(std::string text);

/// Throws Error unless these are the sizes of a three-dimensional volume of at most 2^30 voxels.
ivec3 checked_sizes(const std::vector<double>& sizes, const std::filesystem::path& path);

/// Throws an Error that a file is truncated. `what`: "bytes", "numbers".
[[noreturn]] void refuse_truncated(double there, double promised, std::string_view what,
                                   const std::filesystem::path& path);

/// The grid of a volume, in the file's own unit of length. The world's axes are DICOM's: x to the left, y to
/// the back, z up.
struct Grid {
    ivec3 dims = ivec3(0);
    dvec3 spacing = dvec3(1), origin = dvec3(0);
    dmat3 direction = dmat3(1);

    dvec3 place(dvec3 voxel) const { return origin + direction * (spacing * voxel); }
    std::size_t count() const { return std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z); }
};

/// The grid whose voxel v lies at origin + steps · v. Nothing if a step is zero, if the steps are not
/// orthogonal (within 1e-3), or if a number is larger than any scanner writes.
std::optional<Grid> grid_of(ivec3 dims, const dmat3& steps, dvec3 origin);

/// The same; throws an Error that says what is wrong.
Grid checked_grid(ivec3 dims, const dmat3& steps, dvec3 origin, const std::filesystem::path& path);

/// Metres per unit of length, which a file names in small letters ("mm", "micron"). 0 if it names none; 0 and
/// a note if it is unknown.
double named_unit(const std::string& name, std::vector<std::string>& notes);

/// The note on a file that states no spacing, where 1 is taken.
constexpr const char* no_spacing =
    "it states no spacing: 1 mm is assumed, or 1 of the unit given for the file";

/// The contents of a file, unconverted.
struct Reading {
    Grid grid;
    std::vector<float> values;       // x runs fastest
    double unit = 0;                 // metres; 0 if the file states none
    std::vector<std::string> notes;  // what was assumed, skipped or changed
};

/// NIfTI-1 and NIfTI-2 in one file or as a pair .hdr and .img, and Analyze 7.5.
Reading read_nifti(const std::filesystem::path& path);
Reading read_nrrd(const std::filesystem::path& path);
Reading read_metaimage(const std::filesystem::path& path);

/// A DICOM series; `path`: its folder, a folder above, or one of its files.
Reading read_dicom(const std::filesystem::path& path);

/// True if a file has the DICM prefix, or begins like a data set without it.
bool is_dicom(const std::filesystem::path& path);

}  // namespace palpate
