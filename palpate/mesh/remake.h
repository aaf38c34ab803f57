#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/repair.h"

#include <string>

namespace palpate {

/// A voxel remesh, and how it differs from the original.
struct Remade {
    Mesh solid;
    Dropped hollows{};           // those that were filled, because no wall of the mesh bounds them
    Dropped bits{};              // dropped parts of fewer than 64 voxels, which arise at thin gaps and walls
    std::size_t thin_faces = 0;  // faces of the mesh that are mostly lost, because its walls are thinner than
                                 // a voxel there
    double thin = 0;             // their share of the mesh's area
};

/// Voxel remeshing: makes a new solid, the surface around all points where the mesh's winding number is above
/// a half, as an isosurface of a grid of signed distances. The mesh may be open, intersect itself, be nested
/// or in many pieces; only its faces should be oriented outwards. The result is closed, oriented outwards,
/// and within about half a voxel of the mesh; sharp edges are rounded by as much. A hollow stays a cavity if
/// a part of the mesh that faces inwards encloses it, or if three quarters of its wall belong to one part and
/// it is about four voxels wide: a chamber behind a neck that voxels close. Other hollows, such as gaps
/// between parts that lie on each other, are filled. `voxel`: m; 0 is 1/300 of the longest side. Memory: at
/// most 8 bytes for each voxel of the mesh's bounding box. `name`: of the mesh, for errors. Throws Error if
/// nothing of it encloses a voxel's width, or if the grid would have more than 2^28 voxels.
Remade remake(const Mesh& mesh, float voxel = 0, const std::string& name = "the mesh",
              const Progress& progress = {});

}  // namespace palpate
