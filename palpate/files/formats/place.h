#pragma once
#include "palpate/base/vectors.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// An affine transform of a part of a file: a linear map, which may scale and mirror, and then a translation.
struct Place {
    dmat3 turn = dmat3(1);
    dvec3 move = dvec3(0);

    dvec3 of(dvec3 point) const { return turn * point + move; }

    /// Transforms a normal, made unit: by the cofactors of the matrix, which are cross products of its
    /// columns.
    dvec3 normal(dvec3 n) const {
        const dmat3 cofactors(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                              glm::cross(turn[0], turn[1]));
        const dvec3 turned = (mirrors() ? -1.0 : 1.0) * (cofactors * n);
        const double length = glm::length(turned);
        return length > 0 ? turned / length : dvec3(0, 0, 1);
    }

    bool mirrors() const { return glm::determinant(turn) < 0; }
};

/// Whether faces must be flipped, because most of these transforms mirror.
inline bool mostly_mirrored(std::span<const Place> places) {
    return 2 * std::size_t(std::ranges::count_if(places, &Place::mirrors)) > places.size();
}

/// Linear blend skinning: the weighted mean of the bones' transforms for each vertex.
class MeanPlaces {
 public:
    explicit MeanPlaces(std::size_t vertices)
        : sums_(vertices, Place{dmat3(0), dvec3(0)}), weights_(vertices, 0.0) {}

    void add(std::size_t vertex, const Place& bone, double weight) {
        sums_[vertex].turn += weight * bone.turn;
        sums_[vertex].move += weight * bone.move;
        weights_[vertex] += weight;
    }

    /// One for each vertex; `otherwise` if the sum of its weights is not above 0.
    std::vector<Place> take(const Place& otherwise) && {
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] =
                weights_[i] > 0 ? Place{sums_[i].turn / weights_[i], sums_[i].move / weights_[i]} : otherwise;
        return std::move(sums_);
    }

 private:
    std::vector<Place> sums_;  // times weight
    std::vector<double> weights_;
};

/// The composition: `inner`, then `outer`.
inline Place operator*(const Place& outer, const Place& inner) {
    return {outer.turn * inner.turn, outer.of(inner.move)};
}

inline dmat3 scale_by(dvec3 s) { return {s.x, 0, 0, 0, s.y, 0, 0, 0, s.z}; }

/// A rotation by an angle (rad) about an axis of any length; the identity if the axis is zero.
inline dmat3 turn_about(dvec3 axis, double angle) {
    const double length = glm::length(axis);
    if (!(length > 0)) return dmat3(1);
    const dvec3 a = axis / length;
    const double s = glm::sin(angle), c = glm::cos(angle);
    const dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return c * dmat3(1) + s * cross + (1 - c) * glm::outerProduct(a, a);
}

}  // namespace palpate
