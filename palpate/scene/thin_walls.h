#pragma once
#include "palpate/body/collider.h"
#include "palpate/mesh/mesh.h"

#include <optional>

namespace palpate {

/// How thick the walls of a closed mesh are, m; infinity if it has none. A wall is where the faces on both
/// sides are parallel, so edges and tips do not count; and a twentieth of the surface is no thicker than
/// this, so neither do slivers and small parts.
float wall_thickness(const Mesh& mesh);

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
