#pragma once
#include "palpate/base/vectors.h"

#include <cstdint>
#include <vector>

namespace palpate {

/// A box of cells, each filled or empty; x runs fastest.
struct Cells {
    ivec3 dims = ivec3(0);
    std::vector<std::uint8_t> filled;

    std::size_t index(ivec3 c) const { return (std::size_t(c.z) * dims.y + c.y) * dims.x + c.x; }
    bool at(ivec3 c) const {
        return glm::all(glm::greaterThanEqual(c, ivec3(0))) && glm::all(glm::lessThan(c, dims)) &&
               filled[index(c)];
    }
};

/// Chooses the cells that stand for a solid, given which fraction of each lies inside it. Those at least half
/// inside are filled. Of the others, every cell that the solid touches is filled at first, and then taken
/// away again, the emptiest first, where a half-full neighbour stands for its piece of the solid and the
/// shape keeps its topology without it (a "simple" cell: the solid in its 26 neighbours stays in one part,
/// and so does the empty space). So a sheet or a strand thinner than a cell stays whole, in one piece with
/// the rest.
Cells fill(ivec3 dims, const std::vector<float>& inside);

}  // namespace palpate
