#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"
#include "palpate/body/simulation.h"
#include "palpate/solver/origin.h"

#include <algorithm>
#include <vector>

// What every backend shares on the host: the pass, as its kernels read it.

namespace palpate {

#include "palpate/solver/pass.inl"

/// A pass with all that stays the same for a body: gravity, damping, the links of its grid. Nothing
/// touches it.
Pass make_pass(const Body& body, const Simulation& simulation, const Origin& origin = {});

/// The tips where they are `time` seconds into the call.
void place_tips(std::vector<RoundTip>& tips, const Influences& influences, double time);

/// Puts the obstacles where they are `time` seconds into the call, as seen from where the origin is then. The
/// pass has its duration already.
void place_obstacles(Pass& pass, const Simulation& simulation, const Influences& influences, double time,
                     const Origin& origin);

/// The corners of all polygons in a row, three a triangle, as Obstacle::kind counts them.
std::vector<vec3> polygon_corners(const Simulation& simulation);

/// The distance fields in their order.
std::vector<const DistanceField*> distance_fields(const Simulation& simulation);

/// Squared length at which a spring counts as torn, m²: ten times its rest length, or the body's spacing
/// where that is more.
inline float torn_at(float rest, const Body& body) {
    const float longest = 10 * std::max(rest, body.spacing);
    return longest * longest;
}

}  // namespace palpate
