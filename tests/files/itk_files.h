#pragma once
#include "palpate/mesh/volume.h"

#include <filesystem>
#include <random>
#include <string>

namespace palpate {

/// Writes a volume of whole values as ITK does: NRRD (.nrrd, .nhdr) or MetaImage (.mha, .mhd), in
/// millimetres.
void write_with_itk(const Volume& volume, const std::filesystem::path& path, bool compressed);

/// What distinguishes the files of a DICOM series.
struct Series {
    std::string uid = "1.2.3", description = "head";
    double intercept = -1024;
    bool packed = false;  // as JPEG 2000, without loss
};

/// Writes layer z of a volume as one file of a series.
void write_slice(const Volume& volume, int z, const std::filesystem::path& path, const Series& series = {});

/// Writes all of it: IM0, IM1, ... in an order that says nothing.
void write_series(const Volume& volume, const std::filesystem::path& folder, const Series& series = {});

/// Whole values from -1024 to 3000, of an odd size, with no two spacings alike and no axis along the world's.
Volume oblique(ivec3 dims, unsigned seed);

}  // namespace palpate
