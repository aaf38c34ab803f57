#pragma once
#include "palpate/body/dent.h"
#include "palpate/body/feel.h"
#include "palpate/touch/proxy.h"

#include <span>

namespace palpate {

/// What the virtual coupling to its proxy pushes the hand back with: a spring of stiffness · depth and a
/// damper along the normal, together never pulling; along the surface what the proxy is held back with by
/// friction. N. `velocity`: of the hand, m/s. `feels`: one for each surface of the patch; throws Error if
/// there is none for the one that is touched. `lasting`: dents that were there before. The surface then lies
/// as much deeper, and its force along that surface's own normal; it is the gradient of the energy 1/2
/// stiffness · depth². A sheet's dents are felt from the side that they were pressed in from.
dvec3 force(const Proxy& proxy, dvec3 hand, dvec3 velocity, std::span<const Feel> feels,
            std::span<const Dent> lasting = {});

/// How much deeper the surface lies for it there already, m, not below 0.
double lasting_depth(std::span<const Dent> lasting, const Contact& contact);

}  // namespace palpate
