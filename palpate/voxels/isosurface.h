#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

namespace palpate {

/// Extracts the isosurface of a volume at the value `iso` (as marching cubes does): inside is above it.
/// Everything outside the volume counts as below, so the surface is closed where the volume is cut. In world
/// coordinates, metres; welded. A half-integer `iso` keeps the surface of an integer volume off the voxel
/// centres (histogram.h suggests a value). Besides the volume it needs some 80 bytes a face. Throws an Error
/// with the range of values if no voxel is above `iso` or none below.
Mesh isosurface(const Volume& volume, float iso);

}  // namespace palpate
