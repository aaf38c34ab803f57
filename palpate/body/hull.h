#pragma once
#include "palpate/body/body.h"
#include "palpate/mesh/mesh.h"

#include <array>
#include <vector>

namespace palpate {

/// Half of a face of a filled cell that borders an empty one.
struct HullTriangle {
    std::array<int, 3> nodes;  // counter-clockwise seen from outside
    int cell;                  // the cell it belongs to
    vec3 normal;               // at rest, unit: the same for all triangles that face along one axis of the
                               // grid
};

/// The boundary surface of a lattice: two triangles for each face of a filled cell that no other filled cell
/// shares. The lattice may be rotated or mirrored.
std::vector<HullTriangle> hull(const Body& body);

/// Sets the boundary area of each node: a third of each hull triangle at it; in a body without cells, a
/// square of its grid.
void spread_area(Body& body);

/// The hull as a mesh with sharp edges: a node on an edge or a corner gives one vertex for each normal.
Mesh hull_mesh(const Body& body);

}  // namespace palpate
