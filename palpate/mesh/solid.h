#pragma once
#include "palpate/mesh/mesh.h"

#include <memory>
#include <vector>

namespace palpate {

/// The signed distance from a closed mesh, negative inside: exact near the surface, and clamped three voxels
/// away from it (a narrow band). Inside is what a flood fill from outside does not reach, whatever the
/// orientation of the faces. So holes smaller than a voxel do no harm, and a closed cavity counts as solid.
class SignedDistance {
 public:
    /// `voxel`: the spacing of its grid, m; the finest detail it resolves. A closed part thinner than that
    /// has no negative distances. Throws Error if the mesh is open and has no inside, or if the grid would
    /// need more than 2 GB.
    SignedDistance(const Mesh& mesh, float voxel);
    ~SignedDistance();
    SignedDistance(SignedDistance&&) noexcept;
    SignedDistance& operator=(SignedDistance&&) noexcept;

    /// The distances at the points origin + spacing · (i, j, k), x fastest, by trilinear interpolation.
    std::vector<float> sample(vec3 origin, float spacing, ivec3 dims) const;

    struct Grid;  // of voxels

 private:
    std::unique_ptr<Grid> grid_;
};

}  // namespace palpate
