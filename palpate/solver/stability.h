#pragma once
#include "palpate/body/body.h"
#include "palpate/body/simulation.h"

namespace palpate {

/// The highest frequency of a body's free motion about its rest shape, rad/s; 0 where nothing can move. Found
/// by power iteration, so it is at most 1 or 2 % too low.
double highest_frequency(const Body& body);

/// The same with a press of `contact` (Pa/m, pressure_per_metre) on any node: it stiffens one node in one
/// direction, at worst the one with the most area for its mass.
double pressed_frequency(const Body& body, double frequency, float contact);

/// The longest step with which an integrator keeps a motion of this frequency bounded, s: the point where a
/// root of its amplification polynomial leaves the unit circle (architecture.md, "How long a step may be").
/// Infinite at frequency 0 without damping.
double longest_step(Integrator integrator, double frequency, double damping);

/// The share of the longest step that `step = "auto"` takes. Springs stretched far beyond rest raise the
/// highest frequency of a lattice by at most √2, so this is stable at any deformation.
inline constexpr double step_safety = 0.7;

}  // namespace palpate
