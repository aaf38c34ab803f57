#pragma once
#include "palpate/body/body.h"

#include <span>

namespace palpate {

/// The largest stress that its own weight causes in a solid body, Pa, by the theory of beams: cut across
/// gravity into layers of one cell, each layer carries what is above it, up to where the body is held (below
/// that: what hangs from it). It is pressed together by that weight, and bent by it where that does not stand
/// straight above. Divided by a Young's modulus, it says how much the body is strained: at a few hundredths
/// it stands, at a few tenths it sags, and what is slender falls over. `held`: nodes; without any, the lowest
/// layer stands. What sticks out to a side is not looked at by itself. `gravity`: m/s². 0 for what has no
/// cells or no weight.
double own_weight_stress(const Body& body, std::span<const int> held, vec3 gravity);

}  // namespace palpate
