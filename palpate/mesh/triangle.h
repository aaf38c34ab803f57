#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// Weights of the corners a, b and c that make the point of their triangle nearest to p; from 0 to 1, their
/// sum 1. A collapsed triangle gives the nearest point of its sides.
vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c);
dvec3 nearest_weights(dvec3 p, dvec3 a, dvec3 b, dvec3 c);

}  // namespace palpate
