#pragma once
#include "palpate/body/collider.h"
#include "palpate/mesh/mesh.h"

namespace palpate {

/// What a collider looks like, with normals: a capsule, a box, a polygon's triangles, the surface in a
/// distance field. Empty for a plane and a sphere, which a Picture shows as a Ground and a Ball.
Mesh shape_mesh(const Collider& collider);

}  // namespace palpate
