#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

#include <filesystem>

namespace palpate {

/// Reads a surface (PLY in all three of its forms, OBJ; either may be a gzip) whose coordinates are in
/// `units`. All groups of the file become one mesh. Faces with more than three corners are cut into fans of
/// triangles. A PLY file's vertices stay as they are (see repair.h to weld them); an OBJ file's are those
/// that its faces use, in that order, one for each position and normal; what is written as text comes back
/// exactly from 1.5e-8 to 1e18 in size, and within 4 units in the last place beyond. Normals are kept where
/// the file has one for every vertex, or for every corner. Throws Error if the file is missing, truncated,
/// damaged, has no faces, has coordinates that are not finite, or has faces that name vertices which do not
/// exist.
Mesh read_mesh(const std::filesystem::path& path, Units units);

/// True if a name ends like a volume's: .nii or .nii.gz.
bool is_volume(const std::filesystem::path& path);

/// Reads a scalar volume (NIfTI-1: .nii, .nii.gz) of any kind of number. Its spacing and origin are in
/// `units`; NIfTI means millimetres, and a file that says that it is in metres or micrometres is brought to
/// millimetres first. Throws Error if the file is missing, truncated, damaged, claims more voxels than it
/// holds or than 2^30, has values that are not finite, axes that are not at right angles, or is not
/// three-dimensional. Allocates only for voxels that are really there.
Volume read_volume(const std::filesystem::path& path, Units units = Units::millimetres);

}  // namespace palpate
