#pragma once
#include "palpate/base/vectors.h"

#include <array>

namespace palpate {

/// Weights of the corners a, b and c that make the point of their triangle nearest to p; from 0 to 1, their
/// sum 1. A collapsed triangle gives the nearest point of its sides.
vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c);
dvec3 nearest_weights(dvec3 p, dvec3 a, dvec3 b, dvec3 c);

/// Whether two triangles come within `reach` of each other, or cut each other.
bool are_near(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double reach);

}  // namespace palpate
