#pragma once
#include "palpate/files/formats/draft.h"

#include <span>

namespace palpate {

// The primitive shapes of VRML and X3D as polygons; round ones have 32 faces around their axis. Each is
// centred at the origin, along y, and is added to the draft with its faces oriented outwards.

void add_box(Draft& draft, dvec3 size);
void add_sphere(Draft& draft, double radius);

/// A solid of revolution about y, a cylinder or a cone, of which parts may be missing.
struct Turned {
    double bottom_radius = 1, top_radius = 1, height = 2;
    bool side = true, bottom = true, top = true;
};
void add_turned(Draft& draft, const Turned& shape);

/// An elevation grid over x and z: `heights` in rows of `columns` along x.
void add_elevation_grid(Draft& draft, std::span<const double> heights, std::size_t columns, double x_spacing,
                        double z_spacing);

/// An extrusion: a cross section, in x and z, that is swept along a spine, perpendicular to it. At each point
/// of the spine it is scaled and then rotated; if fewer are given, the last ones repeat. A curve that begins
/// and ends in the same place is closed.
struct Extruded {
    std::vector<dvec2> section, scales;
    std::vector<dvec3> spine;
    std::vector<dmat3> turns;
    bool begin_cap = true, end_cap = true;
};
void add_extrusion(Draft& draft, const Extruded& shape);

}  // namespace palpate
