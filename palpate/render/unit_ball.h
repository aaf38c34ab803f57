#pragma once
#include "palpate/mesh/mesh.h"

namespace palpate {

/// A sphere of radius 1 around the origin, subdivided until its outline is accurate to a thousandth. Its
/// positions are also its normals.
Mesh unit_ball();

}  // namespace palpate
