#pragma once
#include "palpate/base/vectors.h"

#include <glm/gtc/quaternion.hpp>

namespace palpate {

using glm::dquat;

/// Where a thing is that was at the origin, and how it is turned there.
struct Pose {
    dvec3 place = dvec3(0);          // m
    dquat turn = dquat(1, 0, 0, 0);  // of unit length

    /// Where a point p of the thing is.
    dvec3 of(dvec3 p) const { return place + turn * p; }

    bool operator==(const Pose&) const = default;
};

}  // namespace palpate
