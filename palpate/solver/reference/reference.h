#pragma once
#include "palpate/solver/solver.h"

#include <memory>

namespace palpate {

/// The reference backend: one node after the other on one CPU core. Real is float, which other backends must
/// match, or double, which shows orders of convergence without rounding in the way. Does not check the step;
/// make_solver does. `frequency`: the body's highest_frequency, for step = 0.
template <class Real>
std::unique_ptr<Solver> make_reference(const Body& body, const Simulation& simulation, double frequency);

extern template std::unique_ptr<Solver> make_reference<float>(const Body&, const Simulation&, double);
extern template std::unique_ptr<Solver> make_reference<double>(const Body&, const Simulation&, double);

}  // namespace palpate
