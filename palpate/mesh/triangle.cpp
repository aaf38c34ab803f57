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
    // Outside, it is the nearest point of the nearest side.
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

using ThreePoints = std::array<dvec3, 3>;

double distance(dvec3 p, const ThreePoints& t) {
    const dvec3 w = nearest_weights(p, t[0], t[1], t[2]);
    return glm::distance(p, w.x * t[0] + w.y * t[1] + w.z * t[2]);
}

// Whether a segment crosses a triangle's plane within `reach` of the triangle.
bool passes(dvec3 from, dvec3 to, const ThreePoints& t, double reach) {
    const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double start = glm::dot(normal, from - t[0]), end = glm::dot(normal, to - t[0]);
    return start != end && start * end <= 0 &&
           distance(glm::mix(from, to, start / (start - end)), t) <= reach;
}

// Whether two segments come that near at inner points of both.
bool boxes_are_near(const ThreePoints& a, const ThreePoints& b, double reach) {
    const auto low = [](const ThreePoints& c) { return glm::min(glm::min(c[0], c[1]), c[2]); };
    const auto high = [](const ThreePoints& c) { return glm::max(glm::max(c[0], c[1]), c[2]); };
    return glm::all(glm::lessThanEqual(low(a), high(b) + reach)) &&
           glm::all(glm::lessThanEqual(low(b), high(a) + reach));
}

bool sides_are_near(dvec3 p, dvec3 q, dvec3 r, dvec3 s, double reach) {
    const dvec3 u = q - p, w = s - r, off = p - r;
    const double uu = glm::dot(u, u), uw = glm::dot(u, w), ww = glm::dot(w, w), u_off = glm::dot(u, off),
                 w_off = glm::dot(w, off), area = uu * ww - uw * uw;
    if (!(area > 0)) return false;  // parallel
    const double x = (uw * w_off - ww * u_off) / area, y = (uu * w_off - uw * u_off) / area;
    return x >= 0 && x <= 1 && y >= 0 && y <= 1 && glm::length(off + x * u - y * w) <= reach;
}

}  // namespace

bool are_near(const ThreePoints& a, const ThreePoints& b, double reach) {
    if (!boxes_are_near(a, b, reach)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (distance(a[i], b) <= reach || distance(b[i], a) <= reach || passes(a[i], a[next], b, reach) ||
            passes(b[i], b[next], a, reach))
            return true;
        for (std::size_t j = 0; j < 3; ++j)
            if (sides_are_near(a[i], a[next], b[j], b[(j + 1) % 3], reach)) return true;
    }
    return false;
}

// With an angle of less than two degrees at a, floats would take points within the triangle for points beside
// it.
vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c) {
    const vec3 ab = b - a, ac = c - a;
    const float bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
    const bool is_sliver = bb * cc - bc * bc < 1e-3f * bb * cc;
    return is_sliver ? vec3(nearest<dvec3>(p, a, b, c)) : nearest(p, a, b, c);
}
dvec3 nearest_weights(dvec3 p, dvec3 a, dvec3 b, dvec3 c) { return nearest(p, a, b, c); }

}  // namespace palpate
