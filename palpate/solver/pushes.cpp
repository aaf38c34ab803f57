#include "palpate/solver/pushes.h"

#include <algorithm>

namespace palpate {

std::vector<NodePush> by_node(std::span<const NodePush> pushes) {
    std::vector<NodePush> sorted(pushes.begin(), pushes.end()), all;
    std::ranges::stable_sort(sorted, {}, &NodePush::node);
    for (const NodePush& push : sorted) {
        if (all.empty() || all.back().node != push.node) {
            all.push_back(push);
            continue;
        }
        NodePush& sum = all.back();
        sum.force += push.force;
        if (!(push.stiffness > 0)) continue;
        sum.stiffness += push.stiffness;
        const float part = push.stiffness / sum.stiffness;
        sum.to += part * (push.to - sum.to);
        sum.velocity += part * (push.velocity - sum.velocity);
    }
    return all;
}

}  // namespace palpate
