#pragma once
#include "palpate/body/body.h"
#include "palpate/mesh/mesh.h"

#include <array>
#include <vector>

namespace palpate {

/// Half of a face of a filled cell that looks at an empty place.
struct HullTriangle {
    std::array<int, 3> nodes;  // counter-clockwise seen from outside
    int cell;                  // the cell it belongs to
    vec3 normal;               // at rest, unit: the same for all that look along one axis of the grid
};

/// The outside of a lattice: two triangles for each face of a filled cell that no filled cell covers. It may
/// lie turned, or be its own mirror image.
std::vector<HullTriangle> hull(const Body& body);

/// Sets the part of the outside that each node stands for: a third of each hull triangle at it; of a body
/// without cells a square of its grid.
void spread_area(Body& body);

/// The hull as a surface, with sharp edges: a node on an edge or a corner gives one vertex for each
/// direction.
Mesh hull_mesh(const Body& body);

}  // namespace palpate
