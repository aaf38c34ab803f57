#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <limits>

namespace palpate {
namespace {

template <class Vector>
Vector nearest(Vector p, Vector a, Vector b, Vector c) {
    using Real = typename Vector::value_type;
    const Vector ab = b - a, ac = c - a, ap = p - a;
    const Real bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
    const Real bp = glm::dot(ab, ap), cp = glm::dot(ac, ap), area = bb * cc - bc * bc;
    if (area > 0) {
        const Real y = (cc * bp - bc * cp) / area, z = (bb * cp - bc * bp) / area;
        if (y >= 0 && z >= 0 && y + z <= 1) return {1 - y - z, y, z};
    }
    // Outside: the nearest point of the nearest side.
    Vector best(1, 0, 0);
    Real shortest = std::numeric_limits<Real>::max();
    auto try_side = [&](Vector from, Vector to, int i, int j) {
        const Vector side = to - from;
        const Real t = std::clamp(glm::dot(p - from, side) / std::max(glm::dot(side, side), Real(1e-30f)),
                                  Real(0), Real(1));
        const Vector away = p - (from + t * side);
        if (glm::dot(away, away) >= shortest) return;
        shortest = glm::dot(away, away);
        best = Vector(0);
        best[i] = 1 - t;
        best[j] += t;
    };
    try_side(a, b, 0, 1);
    try_side(b, c, 1, 2);
    try_side(c, a, 2, 0);
    return best;
}

}  // namespace

vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c) { return nearest(p, a, b, c); }
dvec3 nearest_weights(dvec3 p, dvec3 a, dvec3 b, dvec3 c) { return nearest(p, a, b, c); }

}  // namespace palpate
