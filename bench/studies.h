#pragma once
#include "palpate/body/body.h"
#include "palpate/body/simulation.h"

#include <vector>

// Measurements of the physics against what theory says. The tests hold them to bounds; palpate-tables prints
// them for docs/results.md. All that move run on the reference solver in double.

namespace palpate::studies {

/// The kinds of damping that a chain or a lattice is studied with.
struct Damping {
    const char* name;
    float of_nodes;  // 1/s
    float of_links;  // s
};
inline constexpr Damping dampings[] = {
    {"none", 0, 0}, {"of velocities", 4, 0}, {"along the springs", 0, 4e-4f}};

/// 9 coupled nodes in a row, of unlike masses, the first of them held.
Body chain(const Damping& damping);

/// log2 of how much smaller the error gets when the step is halved, from `steps` to 2 · `steps`, of that
/// chain as it swings.
double order(Integrator integrator, const Damping& damping, int steps);

/// Whether the motion of a lattice whose nodes are slightly shaken grows with a step of this part of
/// longest_step().
bool grows(Integrator integrator, const Damping& damping, double part);

/// The longest stable step of that lattice, s.
struct Limit {
    double measured;   // by bisection: a step longer by half a percent lets the motion grow
    double predicted;  // longest_step()
    double frequency;  // rad/s, the highest of the lattice
};
Limit stability_limit(Integrator integrator, const Damping& damping);

/// How much the fastest motion of that lattice grows in a step, less 1; `step` in units of 1/frequency.
struct Growth {
    double measured, predicted;
};
Growth growth_per_step(Integrator integrator, double step);

/// The speed of a plane pulse inside a lattice over √(3k/(hρ)), or of a shear pulse over √(k/(hρ)).
double pulse_speed(bool shear);

/// The sag of a square cantilever under its own weight, so many cells thick and ten times as long, over
/// Timoshenko's.
double cantilever_sag(int cells);

/// The least and the largest energy over the first in a million undamped steps of a lattice.
struct Swing {
    double least, largest;
    double drift;  // of the mean, from the first tenth to the last
};
Swing energy_swing(Integrator integrator, int steps);

/// How far normals are off those of finite differences of the surface that the same formulas displace,
/// degrees: the most within three widths of the middle of one dent, 10 mm wide, on a sphere. By
/// dented_normal(), and by section IV.B of 2007 as it is printed, with the sign of its exponent mended, with
/// its axis made unit, and with both. That paper moves vertices outwards, so its normals are held to those of
/// a bump. `width_over_radius`: 0 to 1, 0 being a plane; `depth_over_width` times it must stay under 1, where
/// the surface would turn inside out.
struct DentNormals {
    double ours = 0;
    double printed = 0, with_exponent = 0, with_axis = 0, with_both = 0;
};
DentNormals dent_normals(double width_over_radius, double depth_over_width);

/// How well each mapping carries a surface, as Markdown on standard output (bench/embedding.cpp).
void print_mappings();

}  // namespace palpate::studies
