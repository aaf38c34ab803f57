#pragma once
#include "palpate/base/vectors.h"

#include <cstdint>
#include <vector>

namespace palpate {

/// A box of cells, each filled or empty; x runs fastest.
struct Cells {
    ivec3 dims = ivec3(0);
    std::vector<std::uint8_t> filled;
    std::vector<float> parts = {};  // of each cell, how much is inside the solid; empty: all of it

    std::size_t index(ivec3 c) const { return (std::size_t(c.z) * dims.y + c.y) * dims.x + c.x; }
    bool at(ivec3 c) const {
        return glm::all(glm::greaterThanEqual(c, ivec3(0))) && glm::all(glm::lessThan(c, dims)) &&
               filled[index(c)];
    }
};

/// What 4 × 4 × 4 points spread over a cell know of a solid: bit x + 4 y + 16 z of each word is the point's.
struct Samples {
    std::uint64_t inside = 0;  // the point is inside the solid
    std::uint64_t near = 0;    // the solid's surface passes the point's own part of the cell
};

/// Chooses the cells that stand for a solid, from the fullest to the emptiest: a cell is filled
///   - if at least half of its points are inside the solid;
///   - or if some point that the solid touches would else lie more than half a cell away from every filled
///   neighbour;
///   - or if without it parts would fall apart that hang together through its points.
/// So the filled volume is the solid's, a sheet or a strand however thin stays whole, one cell thick and in
/// one piece with the rest, and a gap a cell wide is not bridged.
Cells fill(ivec3 dims, const std::vector<Samples>& samples);

}  // namespace palpate
