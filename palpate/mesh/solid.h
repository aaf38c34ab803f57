#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

#include <memory>
#include <vector>

namespace palpate {

/// The surface where the volume's value is `iso`: the inside is above it. Outside the volume counts as below,
/// so that the surface is closed where the volume is cut. In the world's coordinates, metres; welded. A
/// half-integer `iso` keeps the surface of an integer volume off the voxels themselves. Throws Error, naming
/// the range of values, if no voxel is above `iso` or none below.
Mesh isosurface(const Volume& volume, float iso);

/// Signed distance from a closed mesh, negative inside, exact near the surface and cut off three voxels away
/// from it. What cannot be reached from outside is inside, whichever way the faces turn. So holes smaller
/// than a voxel do no harm, and a cavity without a wider way out counts as solid.
class SignedDistance {
 public:
    /// `voxel`: the width of its grid, m; the finest detail it sees. A closed part thinner than that has no
    /// negative distances. Throws Error if the mesh is open and has no inside, or if the grid would need more
    /// than 2 GB.
    SignedDistance(const Mesh& mesh, float voxel);
    ~SignedDistance();
    SignedDistance(SignedDistance&&) noexcept;
    SignedDistance& operator=(SignedDistance&&) noexcept;

    /// The distances at the points origin + spacing · (i, j, k), x fastest, by trilinear interpolation.
    std::vector<float> sample(vec3 origin, float spacing, ivec3 dims) const;

 private:
    struct Grid;  // keeps OpenVDB's headers in one .cpp
    std::unique_ptr<Grid> grid_;
};

}  // namespace palpate
