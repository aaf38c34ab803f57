#pragma once
#include "palpate/body/body.h"
#include "palpate/body/simulation.h"

#include <string>

namespace palpate {

/// What would make automatic steps longer, for a message where they are too short. What shortens them is
/// found by working the step out again without it, so nothing is blamed that has no part in it. `frequency`:
/// the highest of the body's free motion, rad/s; `wanted`: how long steps must be, s.
std::string how_to_lengthen_steps(const Body& body, const Simulation& simulation, double frequency,
                                  double wanted);

}  // namespace palpate
