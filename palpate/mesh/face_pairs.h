#pragma once
#include "palpate/mesh/tree.h"

#include <vector>

namespace palpate {

/// Broad phase: visits the pairs of leaves of a tree whose bounding boxes are no farther apart than `reach`
/// (m), each pair once, and each leaf with itself. It skips what is below two nodes for which skip(node,
/// node) is true. Ends early if visit(leaf, leaf) returns false. `waiting`: a stack of the pairs of nodes to
/// search, where a node with itself means all pairs within it; afterwards what remains of them.
template <class Skip, class Visit>
void for_each_pair_of_leaves(const Tree& tree, std::vector<uvec2>& waiting, float reach, Skip skip,
                             Visit visit) {
    const auto apart = [reach](const Tree::Node& a, const Tree::Node& b) {
        return glm::any(glm::greaterThan(a.low - reach, b.high)) ||
               glm::any(glm::greaterThan(b.low - reach, a.high));
    };
    while (!waiting.empty()) {
        const uvec2 pair = waiting.back();
        waiting.pop_back();
        const Tree::Node &a = tree.nodes[pair.x], &b = tree.nodes[pair.y];
        if (apart(a, b) || skip(pair.x, pair.y)) continue;
        if (pair.x == pair.y && a.second != 0) {
            const Index first = pair.x + 1;
            waiting.insert(waiting.end(), {{first, first}, {a.second, a.second}, {first, a.second}});
        } else if (a.second != 0 && (b.second == 0 || a.count >= b.count)) {
            waiting.insert(waiting.end(), {{pair.x + 1, pair.y}, {a.second, pair.y}});
        } else if (b.second != 0) {
            waiting.insert(waiting.end(), {{pair.x, pair.y + 1}, {pair.x, b.second}});
        } else if (!visit(pair.x, pair.y)) {
            return;
        }
    }
}

/// The same for the whole tree; returns whether it was completed.
template <class Skip, class Visit>
bool for_each_pair_of_leaves(const Tree& tree, float reach, Skip skip, Visit visit) {
    std::vector<uvec2> waiting;
    if (!tree.nodes.empty()) waiting.push_back({0, 0});
    bool ended = true;
    for_each_pair_of_leaves(tree, waiting, reach, skip,
                            [&](Index a, Index b) { return ended = visit(a, b); });
    return ended;
}

/// Calls visit(i, j) for each pair of faces of two leaves, by their indices in `tree.faces`.
template <class Visit>
void for_each_pair_of_faces(const Tree& tree, Index leaf, Index other, Visit visit) {
    const Tree::Node &a = tree.nodes[leaf], &b = tree.nodes[other];
    for (Index i = a.first; i < a.first + a.count; ++i)
        for (Index j = leaf == other ? i + 1 : b.first; j < b.first + b.count; ++j) visit(i, j);
}

}  // namespace palpate
