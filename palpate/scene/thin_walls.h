#pragma once
#include "palpate/body/collider.h"
#include "palpate/mesh/mesh.h"

#include <optional>

namespace palpate {

/// Walls of a closed mesh that its signed distance field may miss, because no grid point is deep enough
/// inside them: nodes may pass through them.
struct ThinWalls {
    float share = 0;     // of the surface
    float thinnest = 0;  // m, the thinnest of those that were sampled
    float spacing = 0;   // m, with which a field would resolve them
};

/// Nothing if they are at most a hundredth of the surface.
std::optional<ThinWalls> thin_walls(const Mesh& mesh, const DistanceField& field);

}  // namespace palpate
