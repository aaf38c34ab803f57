#pragma once
#include "palpate/body/collider.h"
#include "palpate/mesh/mesh.h"

#include <optional>

namespace palpate {

/// Walls of a closed mesh that its field may not see, because none of its points lies deep enough in them:
/// what meets them may go through.
struct ThinWalls {
    float share = 0;     // of the surface
    float thinnest = 0;  // m, of those that were looked at
    float spacing = 0;   // m, with which a field would see them
};

/// Nothing where they are no more than a hundredth of the surface.
std::optional<ThinWalls> thin_walls(const Mesh& mesh, const DistanceField& field);

}  // namespace palpate
