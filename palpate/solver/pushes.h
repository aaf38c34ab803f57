#pragma once
#include "palpate/body/influences.h"

#include <vector>

namespace palpate {

/// All that is done to each node together, in the order of the nodes, one push a node: springs add up to one
/// spring towards the mean of their points.
std::vector<NodePush> by_node(std::span<const NodePush> pushes);

/// Where a push draws its node `time` seconds into the call, m.
inline vec3 target(const NodePush& push, float time) { return push.to + time * push.velocity; }

/// The force of a push on a node at a place, N.
template <class Vector>
Vector force_on(const NodePush& push, float time, const Vector& place) {
    return Vector(push.force) +
           typename Vector::value_type(push.stiffness) * (Vector(target(push, time)) - place);
}

}  // namespace palpate
