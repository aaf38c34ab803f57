#pragma once
#include "palpate/body/dent.h"
#include "palpate/body/feel.h"
#include "palpate/touch/proxy.h"

#include <span>

namespace palpate {

/// The contact force on the hand, N: a penalty force by the virtual coupling to its proxy. Along the normal a
/// spring, stiffness · depth, and a damper, which together never pull; along the surface the friction that
/// holds the proxy back. `velocity`: of the hand, m/s. `feels`: one for each surface of the patch; throws
/// Error if there is none for the one that is touched. `lasting`: dents that were there before. They lower
/// the surface, so the force acts along the normal of the dented surface: it is the gradient of the energy
/// 1/2 stiffness · depth². A sheet's dents are felt from the side from which they were pressed in.
/// `from`: only contacts with surfaces of this number or higher push.
dvec3 force(const Proxy& proxy, dvec3 hand, dvec3 velocity, std::span<const Feel> feels,
            std::span<const Dent> lasting = {}, int from = 0);

/// By how much lasting dents lower the surface at a contact, m, not below 0.
double lasting_depth(std::span<const Dent> lasting, const Contact& contact);

}  // namespace palpate
