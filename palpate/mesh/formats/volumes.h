#pragma once
#include "palpate/base/vectors.h"
#include "palpate/mesh/volume.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

// What stands between a volume's files and ITK, which believes what they claim: each is looked through first,
// and ITK works in a process of its own.

/// 1024³: four gigabytes of values.
constexpr double most_voxels = 1 << 30;

[[noreturn]] void refuse(std::string_view what, const std::filesystem::path& path,
                         std::string_view remedy = "export it again");

/// Throws Error unless these are the sizes of a volume of three dimensions and at most 2^30 voxels.
void check_sizes(const std::vector<double>& sizes, const std::filesystem::path& path);

/// Throws Error that a file holds less than it promises.
[[noreturn]] void refuse_truncated(double there, double promised, const std::filesystem::path& path);

/// Where the voxels lie, in millimetres and ITK's axes.
struct Grid {
    ivec3 dims = ivec3(0);
    dvec3 spacing = dvec3(1), origin = dvec3(0);
    dmat3 direction = dmat3(1);
};

/// What a look through a file has found: how many bytes its voxels may take in ITK's hands, and what ITK gets
/// wrong about where they lie.
struct Found {
    double bytes = 0;
    double origin_scale = 1;  // of NIfTI: ITK applies the file's unit of length to the spacing only
    dvec3 turn = dvec3(1);    // of NRRD's space LAS: ITK turns the wrong axis
};

// Each throws Error if the file is missing, damaged or truncated, or promises more than it holds. They read
// the file in small blocks.
Found look_through_nifti(const std::filesystem::path& path);
Found look_through_nrrd(const std::filesystem::path& path);
Found look_through_metaimage(const std::filesystem::path& path);

/// Reads what has been looked through.
Volume read_with_itk(const std::filesystem::path& path, const Found& found);

/// One file of a DICOM series.
struct Slice {
    std::filesystem::path file;
    std::string series, description;
    Grid grid;
};

/// True of a file that bears DICOM's mark, and of a folder with such a file in it.
bool is_dicom(const std::filesystem::path& path);

/// The files with DICOM's mark in a folder, by name.
std::vector<std::filesystem::path> dicom_files(const std::filesystem::path& folder);

/// The series that `path`, a file, belongs to; or if it is the folder, the only one of more than one slice.
/// Throws Error, with a list of the series, if there are several.
std::vector<Slice> one_series(const std::vector<Slice>& slices, const std::filesystem::path& path);

/// Sorts slices from the lowest to the highest and returns the grid that they make up together. Throws Error
/// unless they are alike, evenly spaced and straight above each other.
Grid stack(std::vector<Slice>& slices, const std::filesystem::path& path);

/// Reads a series of slices; `path` is a folder, or a file of the series in it.
Volume read_dicom(const std::filesystem::path& path);

}  // namespace palpate
