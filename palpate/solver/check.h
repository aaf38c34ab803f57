#pragma once
// What a caller can get wrong about a solver. Every backend asks before it is made, and before anything
// moves.
#include "palpate/body/body.h"
#include "palpate/body/influences.h"
#include "palpate/body/simulation.h"

namespace palpate {

/// Throws Error if a body does not hold (check(body)), or a simulation's numbers or colliders cannot be.
void check(const Body& body, const Simulation& simulation);

/// Throws Error if a call of Solver::step asks for what cannot be.
void check(double seconds, const Influences& influences, const Body& body, const Simulation& simulation);

/// For undo() where no call is left to take back.
[[noreturn]] void refuse_undo(const Body& body);

/// Throws Error if a state is not of this body.
void check(const State& state, const Body& body);

}  // namespace palpate
