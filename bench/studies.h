#pragma once
#include "palpate/body/body.h"
#include "palpate/body/material.h"
#include "palpate/body/simulation.h"

#include <vector>

// Measurements of the physics against theory. The tests check them against bounds; palpate-tables prints them
// for docs/results.md. All simulations run on the reference solver in double.

namespace palpate::studies {

/// The Rayleigh damping that a chain or a lattice is studied with.
struct Damping {
    const char* name;
    float of_nodes;  // 1/s
    float of_links;  // s
};
inline constexpr Damping dampings[] = {
    {"none", 0, 0}, {"of velocities", 4, 0}, {"along the springs", 0, 4e-4f}};

/// A body to study, with that damping.
using Studied = Body(const Damping&);
/// 9 coupled nodes in a row, of unlike masses, the first of them held.
Studied chain;
/// Two cells of tissue in a row, held at one end, which swing as fast as the chain.
Studied tissue_chain;
/// A lattice of springs, or of tissue, held at one side.
Studied small_lattice, small_tissue;

/// The order of convergence that is measured on a chain as it swings: log2 of its error with `steps` steps
/// over that with 2 · `steps`.
double order(Studied body, Integrator integrator, const Damping& damping, int steps);

/// Whether the motion of a slightly shaken lattice grows with a step of `part` times longest_step().
bool grows(Studied body, Integrator integrator, const Damping& damping, double part);

/// The longest stable step of that lattice, s.
struct Limit {
    double measured;   // by bisection: a step longer by half a percent lets the motion grow
    double predicted;  // longest_step()
    double frequency;  // rad/s, the highest of the lattice
};
Limit stability_limit(Integrator integrator, const Damping& damping);

/// By how much the vibration of a pair of nodes grows in a step, less 1; `step` in units of 1/frequency.
struct Growth {
    double measured, predicted;
};
Growth growth_per_step(Integrator integrator, double step);

/// The speed of a longitudinal plane pulse inside a lattice over √(3k/(hρ)), or of a shear pulse over
/// √(k/(hρ)).
double pulse_speed(bool shear);

/// The sag under its own weight of a square cantilever, `cells` thick and ten times as long, over that of
/// Timoshenko's beam theory.
double cantilever_sag(int cells);

/// The least and the largest energy of a lattice of a model in so many undamped steps, over the initial
/// energy.
struct Swing {
    double least, largest;
    double drift;  // of the mean, from the first tenth to the last
};
Swing energy_swing(Integrator integrator, int steps, MaterialModel model = MaterialModel::springs);

/// The largest angle, in degrees, between normals and those by finite differences of the displaced surface,
/// within three widths of the middle of one dent, 10 mm wide, on a sphere: by dented_normal(), and by section
/// IV.B of the 2007 paper as printed, with the sign of its exponent corrected, with its axis normalised, and
/// with both. That paper moves vertices outwards, so its normals are compared with those of a bump.
/// `width_over_radius`: 0 to 1, 0 being a plane; `depth_over_width` times it must stay below 1, where the
/// surface would turn inside out.
struct DentNormals {
    double ours = 0;
    double printed = 0, with_exponent = 0, with_axis = 0, with_both = 0;
};
DentNormals dent_normals(double width_over_radius, double depth_over_width);

/// How well each mapping carries a surface, as Markdown on standard output (bench/embedding.cpp).
void print_mappings();

}  // namespace palpate::studies
