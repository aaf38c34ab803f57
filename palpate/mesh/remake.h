#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/repair.h"

#include <string>

namespace palpate {

/// What voxels made, and how it differs from what it was made of.
struct Remade {
    Mesh solid;
    Dropped hollows{};           // that were filled, as no wall of the mesh bounds them
    Dropped bits{};              // parts of fewer than 64 voxels, left where gaps and walls are thin
    std::size_t thin_faces = 0;  // of the mesh, most of which is lost, as its walls are thinner than a voxel
    double thin = 0;             // of the mesh's area, the share that is lost so
};

/// A solid made anew by voxels: the surface around all points that the mesh winds around more than half, read
/// off a grid of distances. The mesh may be open, cut through itself, be nested or in many pieces; only its
/// faces should turn their fronts outward. The result is closed, turns right, and follows the mesh within
/// about half a voxel; sharp edges are rounded by as much. It has a cavity where a part of the mesh that
/// turns inward winds around one, or where three quarters of its wall are one part's and it is four voxels
/// wide or so: a chamber behind a neck that voxels close. Other hollows, such as what is left between parts
/// that lie on each other, are filled. `voxel`: m; 0 is 1/300 of the longest side. Memory: 4 bytes for each
/// voxel of the mesh's box, twice at most. `name`: what errors call the mesh. Throws Error if nothing of it
/// encloses a voxel's width, or if the grid would have more than 2^28 voxels.
Remade remake(const Mesh& mesh, float voxel = 0, const std::string& name = "the mesh",
              const Progress& progress = {});

}  // namespace palpate
