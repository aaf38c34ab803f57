#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <limits>

namespace palpate {

vec3 nearest_weights(vec3 p, vec3 a, vec3 b, vec3 c) {
    const vec3 ab = b - a, ac = c - a, ap = p - a;
    const float bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
    const float bp = glm::dot(ab, ap), cp = glm::dot(ac, ap), area = bb * cc - bc * bc;
    if (area > 0) {
        const float y = (cc * bp - bc * cp) / area, z = (bb * cp - bc * bp) / area;
        if (y >= 0 && z >= 0 && y + z <= 1) return {1 - y - z, y, z};
    }
    // Outside: the nearest point of the nearest side.
    vec3 best(1, 0, 0);
    float shortest = std::numeric_limits<float>::max();
    auto try_side = [&](vec3 from, vec3 to, int i, int j) {
        const vec3 side = to - from;
        const float t =
            std::clamp(glm::dot(p - from, side) / std::max(glm::dot(side, side), 1e-30f), 0.0f, 1.0f);
        const vec3 away = p - (from + t * side);
        if (glm::dot(away, away) >= shortest) return;
        shortest = glm::dot(away, away);
        best = vec3(0);
        best[i] = 1 - t;
        best[j] += t;
    };
    try_side(a, b, 0, 1);
    try_side(b, c, 1, 2);
    try_side(c, a, 2, 0);
    return best;
}

}  // namespace palpate
