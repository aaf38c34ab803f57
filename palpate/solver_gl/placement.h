#pragma once
#include "palpate/body/body.h"

#include <vector>

namespace palpate::gpu {

/// Where a body's nodes lie in the GPU's memory, each in a slot: in the box around their grid, so that a link
/// leads equally far from all of them; or, where there is no grid, or its box is mostly empty, in their own
/// order, with their springs written out. Before and behind there is room for what links at the rim reach;
/// there, and where the box has no node, shares are none.
struct Placement {
    explicit Placement(const Body& body);

    bool grid = false;
    ivec3 dims = ivec3(0);     // of a grid's box
    int first = 0;             // slot of its first place
    std::vector<int> offsets;  // in slots, along each link of a grid
    int slots = 0;             // with the room on both sides
    std::vector<int> slot;     // of each node
    std::vector<int> rim;      // the slots of the nodes that tips touch: of the outside, and of all tissue

 private:
    void write_grid(const Body& body);
};

}  // namespace palpate::gpu
