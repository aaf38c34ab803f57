#pragma once
#include "palpate/base/vectors.h"

#include <span>

namespace palpate {

/// Where the current state of a body's nodes is, for whoever maps or draws them. Valid until the solver's
/// next step.
struct Nodes {
    std::span<const vec3> positions;  // m
    std::span<const vec3>
        normals;  // approximate normals (2005, eq. 3), not normalised: a short one is ill defined
};

}  // namespace palpate
