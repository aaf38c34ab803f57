#pragma once
#include "palpate/base/vectors.h"

#include <algorithm>
#include <span>

namespace palpate {

/// Where a part of a file stands: turned, which may scale and mirror it, and then moved.
struct Place {
    dmat3 turn = dmat3(1);
    dvec3 move = dvec3(0);

    dvec3 of(dvec3 point) const { return turn * point + move; }

    /// A normal, made unit. Normals turn with planes: by the cofactors, which cross products of the columns
    /// are.
    dvec3 normal(dvec3 n) const {
        const dmat3 cofactors(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                              glm::cross(turn[0], turn[1]));
        const dvec3 turned = (mirrors() ? -1.0 : 1.0) * (cofactors * n);
        const double length = glm::length(turned);
        return length > 0 ? turned / length : dvec3(0, 0, 1);
    }

    bool mirrors() const { return glm::determinant(turn) < 0; }
};

/// Whether faces between these places are to be turned over: most of them mirror.
inline bool mostly_mirrored(std::span<const Place> places) {
    return 2 * std::size_t(std::ranges::count_if(places, &Place::mirrors)) > places.size();
}

/// What stands at `inner` in a part that itself stands at `outer`.
inline Place operator*(const Place& outer, const Place& inner) {
    return {outer.turn * inner.turn, outer.of(inner.move)};
}

inline dmat3 scale_by(dvec3 s) { return {s.x, 0, 0, 0, s.y, 0, 0, 0, s.z}; }

/// By an angle (rad) about an axis of any length; about none, if that has no length.
inline dmat3 turn_about(dvec3 axis, double angle) {
    const double length = glm::length(axis);
    if (!(length > 0)) return dmat3(1);
    const dvec3 a = axis / length;
    const double s = glm::sin(angle), c = glm::cos(angle);
    const dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return c * dmat3(1) + s * cross + (1 - c) * glm::outerProduct(a, a);
}

}  // namespace palpate
