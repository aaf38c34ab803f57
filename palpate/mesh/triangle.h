#pragma once
#include "palpate/base/vectors.h"

#include <array>

namespace palpate {

/// The barycentric weights of the triangle's point nearest to p: from 0 to 1, with sum 1. For a degenerate
/// triangle, those of the nearest point of its sides.
vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c);
dvec3 nearest_weights(dvec3 p, dvec3 a, dvec3 b, dvec3 c);

/// Whether two triangles come within `reach` of each other, or intersect.
bool are_near(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double reach);

}  // namespace palpate
