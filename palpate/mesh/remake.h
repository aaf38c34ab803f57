#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"

#include <string>

namespace palpate {

/// A solid made anew by voxels: the surface around all points that the mesh winds around more than half, read
/// off a grid of distances. The mesh may be open, cut through itself, be nested or in many pieces; only its
/// faces should turn their fronts outward. The result is closed, turns right, has no cavity that the mesh has
/// not, and follows the mesh within about half a voxel; sharp edges are rounded by as much.
/// `voxel`: m; 0 is 1/300 of the longest side. Memory: 4 bytes for each voxel of the mesh's box, twice at
/// most. `name`: what errors call the mesh. Throws Error if nothing of it encloses a voxel's width, or if the
/// grid would have more than 2^28 voxels.
Mesh remake(const Mesh& mesh, float voxel = 0, const std::string& name = "the mesh",
            const Progress& progress = {});

}  // namespace palpate
