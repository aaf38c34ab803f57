#pragma once
#include "palpate/mesh/mesh.h"

namespace palpate {

/// A ball of radius 1 around the origin, whose outline is true to a thousandth. Its positions are also its
/// normals.
Mesh unit_ball();

}  // namespace palpate
