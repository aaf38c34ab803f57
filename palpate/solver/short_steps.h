#pragma once
#include "palpate/body/body.h"
#include "palpate/body/simulation.h"
#include "palpate/solver/longest_step.h"

#include <string>

namespace palpate {

/// What would make automatic steps longer, for a message where they are too short. What shortens them is
/// found by working the step out again without it, so nothing is blamed that has no part in it. `frequency`:
/// the highest of the body's free motion, rad/s; `tools`: of the tools that act.
std::string how_to_lengthen_steps(const Body& body, const Simulation& simulation, double frequency,
                                  const ToolStiffness& tools);

}  // namespace palpate
