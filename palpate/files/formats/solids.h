#pragma once
#include "palpate/files/formats/draft.h"

#include <span>

namespace palpate {

// The shapes that VRML and X3D know by name, in flat faces; round ones have 32 round their axis. Each lies
// about the origin, along y, and is added to the draft with its faces turned outwards.

void add_box(Draft& draft, dvec3 size);
void add_sphere(Draft& draft, double radius);

/// What is round about y, from the bottom up; a cylinder or a cone, of which parts may be missing.
struct Turned {
    double bottom_radius = 1, top_radius = 1, height = 2;
    bool side = true, bottom = true, top = true;
};
void add_turned(Draft& draft, const Turned& shape);

/// A terrain over x and z: `heights` in rows along x, of which each has `columns`.
void add_terrain(Draft& draft, std::span<const double> heights, std::size_t columns, double x_spacing,
                 double z_spacing);

/// A cross section, in x and z, that is drawn along a spine, which is met at right angles; at each of its
/// points it is scaled and then turned as given (by the last that is given; by nothing if none is). What
/// begins and ends in the same place is closed.
struct Extruded {
    std::vector<dvec2> section, scales;
    std::vector<dvec3> spine;
    std::vector<dmat3> turns;
    bool begin_cap = true, end_cap = true;
};
void add_extrusion(Draft& draft, const Extruded& shape);

}  // namespace palpate
