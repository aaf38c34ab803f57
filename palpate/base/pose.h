#pragma once
#include "palpate/base/vectors.h"

#include <glm/gtc/quaternion.hpp>

namespace palpate {

using glm::dquat;

/// A rigid motion: the position and orientation of a thing that was at the origin.
struct Pose {
    dvec3 place = dvec3(0);          // m
    dquat turn = dquat(1, 0, 0, 0);  // a unit quaternion

    /// The place of the thing's point p.
    dvec3 of(dvec3 p) const { return place + turn * p; }

    bool operator==(const Pose&) const = default;
};

}  // namespace palpate
