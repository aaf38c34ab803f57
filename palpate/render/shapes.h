#pragma once
#include "palpate/body/collider.h"
#include "palpate/mesh/mesh.h"

namespace palpate {

/// The mesh that shows a collider, with normals: a capsule, a box, a polygon's triangles, the zero isosurface
/// of a distance field. Empty for a plane and a sphere, which a Picture shows as a Ground and a Ball.
Mesh shape_mesh(const Collider& collider);

}  // namespace palpate
