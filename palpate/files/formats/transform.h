#pragma once
#include "palpate/base/vectors.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// An affine transform of a part of a file: a linear map, which may scale and mirror, and then a translation.
struct Transform {
    dmat3 linear = dmat3(1);
    dvec3 translation = dvec3(0);

    dvec3 of(dvec3 point) const { return linear * point + translation; }

    /// Transforms a normal, made unit: by the cofactors of the matrix, which are cross products of its
    /// columns.
    dvec3 normal(dvec3 n) const {
        const dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
        const dvec3 turned = (mirrors() ? -1.0 : 1.0) * (cofactors * n);
        const double length = glm::length(turned);
        return length > 0 ? turned / length : dvec3(0, 0, 1);
    }

    bool mirrors() const { return glm::determinant(linear) < 0; }
};

/// Whether faces must be flipped, because most of these transforms mirror.
inline bool mostly_mirror(std::span<const Transform> transforms) {
    return 2 * std::size_t(std::ranges::count_if(transforms, &Transform::mirrors)) > transforms.size();
}

/// Linear blend skinning: the weighted mean of the bones' transforms for each vertex.
class MeanTransforms {
 public:
    explicit MeanTransforms(std::size_t vertices)
        : sums_(vertices, Transform{dmat3(0), dvec3(0)}), weights_(vertices, 0.0) {}

    void add(std::size_t vertex, const Transform& bone, double weight) {
        sums_[vertex].linear += weight * bone.linear;
        sums_[vertex].translation += weight * bone.translation;
        weights_[vertex] += weight;
    }

    /// One for each vertex; `otherwise` if the sum of its weights is not above 0.
    std::vector<Transform> take(const Transform& otherwise) && {
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] = weights_[i] > 0
                           ? Transform{sums_[i].linear / weights_[i], sums_[i].translation / weights_[i]}
                           : otherwise;
        return std::move(sums_);
    }

 private:
    std::vector<Transform> sums_;  // times weight
    std::vector<double> weights_;
};

/// The composition: `inner`, then `outer`.
inline Transform operator*(const Transform& outer, const Transform& inner) {
    return {outer.linear * inner.linear, outer.of(inner.translation)};
}

inline dmat3 scaling_by(dvec3 s) { return {s.x, 0, 0, 0, s.y, 0, 0, 0, s.z}; }

/// A rotation by an angle (rad) about an axis of any length; the identity if the axis is zero.
inline dmat3 rotation_about(dvec3 axis, double angle) {
    const double length = glm::length(axis);
    if (!(length > 0)) return dmat3(1);
    const dvec3 a = axis / length;
    const double s = glm::sin(angle), c = glm::cos(angle);
    const dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return c * dmat3(1) + s * cross + (1 - c) * glm::outerProduct(a, a);
}

}  // namespace palpate
