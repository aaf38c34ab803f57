#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

namespace palpate {

/// The surface where the volume's value is `iso`: the inside is above it. Outside the volume counts as below,
/// so that the surface is closed where the volume is cut. In the world's coordinates, metres; welded. A
/// half-integer `iso` keeps the surface of an integer volume off the voxels themselves (see histogram.h for a
/// suggestion). Beside the volume it takes memory by the surface: some 80 bytes a face. Throws Error, naming
/// the range of values, if no voxel is above `iso` or none below.
Mesh isosurface(const Volume& volume, float iso);

}  // namespace palpate
