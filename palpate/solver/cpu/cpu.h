#pragma once
#include "palpate/solver/solver.h"

#include <memory>
#include <string_view>

namespace palpate {

/// The backend `cpu`: as many nodes at once as a register holds, with the instruction set of the machine it
/// runs on. Grids keep their neighbours implied; all else gathers them. `frequency`: the body's highest,
/// rad/s.
std::unique_ptr<Solver> make_cpu(const Body& body, const Simulation& simulation, double frequency);

/// The instruction set that it uses here: AVX2, AVX3 (that is AVX-512), SSE4, NEON, or SCALAR.
std::string_view cpu_instructions();

}  // namespace palpate
