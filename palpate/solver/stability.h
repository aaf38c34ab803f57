#pragma once
#include "palpate/body/body.h"
#include "palpate/body/simulation.h"

#include <numbers>

namespace palpate {

/// The highest frequency of a body's free motion about its rest shape, rad/s; 0 where nothing can move. Found
/// by power iteration, so it is at most 1 or 2 % too low. Throws Error if the body does not hold (check()).
double highest_frequency(const Body& body);

/// The same with presses of `contact` (Pa/m, pressure_per_metre) and drags of `pull` (N/m) on any node: each
/// stiffens one node in one direction, at worst the one with the most area for its mass, or the lightest.
double touched_frequency(const Body& body, double frequency, float contact, float pull);

/// How much a step of `step` seconds makes a motion of one frequency grow at most: the largest absolute value
/// of the eigenvalues of what the integrator does to position and velocity of x'' = -ω² x - (c + β ω²) x'.
/// The motion stays bounded while that is at most 1. `damping`: c, 1/s; `link_damping`: β, s.
double growth(Integrator integrator, double step, double frequency, double damping, double link_damping);

/// The longest step with which an integrator keeps all motions up to this frequency bounded, s. 0 where there
/// is none: explicit Euler and midpoint without damping. Infinite at frequency 0 without damping.
double longest_step(Integrator integrator, double frequency, double damping, double link_damping = 0);

/// How many times its highest frequency at rest a body may reach when it is deformed far. Springs: √2, which
/// no stretching exceeds. Tissue: 1.7; pressed to four tenths of their height cells reach 1.43
/// (docs/results.md, "Tissue against theory"), and somewhat more where they are sheared besides.
double frequency_reserve(const Body& body);

/// The step that `step = "auto"` takes, s: 0.7 of the longest, and no more than is stable at `reserve` times
/// the frequency.
double automatic_step(Integrator integrator, double frequency, double damping, double link_damping = 0,
                      double reserve = std::numbers::sqrt2);

}  // namespace palpate
