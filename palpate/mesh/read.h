#pragma once
#include <filesystem>

#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

namespace palpate {

/// Reads a surface (PLY, OBJ) whose coordinates are in `units`. Faces with more than three corners are cut into
/// triangles; vertices are not welded (see repair.h). Normals are kept where the file has them.
/// Throws Error if the file is missing, truncated, empty, has coordinates that are not finite, or has faces that
/// name vertices which do not exist.
Mesh read_mesh(const std::filesystem::path& path, Units units);

/// Reads a scalar volume (NIfTI: .nii, .nii.gz) whose spacing is in `units`; NIfTI means millimetres.
/// Throws Error if the file is missing, truncated, claims more voxels than it can hold, has values that are not
/// finite, or is not three-dimensional. Never allocates more than the file's own size can account for.
Volume read_volume(const std::filesystem::path& path, Units units = Units::millimetres);

}  // namespace palpate
