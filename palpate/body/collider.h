#pragma once
#include "palpate/base/vectors.h"

#include <variant>

namespace palpate {

/// Keeps nodes on the side its normal points to: dot(normal, p) >= offset.
struct Plane {
    vec3 normal = vec3(0, 1, 0);  // unit
    float offset = 0;             // m
};

/// Keeps nodes out of a ball.
struct Sphere {
    vec3 centre = vec3(0);  // m
    float radius = 0.1f;    // m
};

/// Something hard and fixed that nodes do not enter (2012, section 4): a node inside is moved to the nearest
/// point of the surface and loses its inward velocity.
using Collider = std::variant<Plane, Sphere>;

}  // namespace palpate
