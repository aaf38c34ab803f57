#include "palpate/body/cells.h"

#include "palpate/body/grid.h"

#include <algorithm>
#include <array>
#include <bitset>

namespace palpate {
namespace {

// A cell's neighbourhood of 3 × 3 × 3 cells, itself in the middle, as 27 bits.
using Block = std::bitset<27>;

constexpr int middle = 13;

constexpr ivec3 place(int bit) { return {bit % 3 - 1, bit / 3 % 3 - 1, bit / 9 - 1}; }

Block block_around(const Cells& cells, ivec3 c) {
    Block block;
    for (int bit = 0; bit < 27; ++bit) block[bit] = cells.at(c + place(bit));
    return block;
}

// For each place of the block, the other places next to it: by faces only, or by faces, edges and corners.
std::array<Block, 27> neighbour_table(bool faces_only) {
    std::array<Block, 27> table;
    for (int a = 0; a < 27; ++a)
        for (int b = 0; b < 27; ++b) {
            const ivec3 d = glm::abs(place(a) - place(b));
            const int sum = d.x + d.y + d.z, largest = std::max({d.x, d.y, d.z});
            table[a][b] = faces_only ? sum == 1 : largest == 1;
        }
    return table;
}

// The places of `block` that can be reached from the place `from` by steps inside it.
Block reach(const Block& block, int from, const std::array<Block, 27>& next_to) {
    Block reached;
    reached[from] = true;
    for (Block edge = reached; edge.any();) {
        Block more;
        for (int bit = 0; bit < 27; ++bit)
            if (edge[bit]) more |= next_to[bit] & block & ~reached;
        reached |= more;
        edge = more;
    }
    return reached;
}

int first(const Block& block) {
    for (int bit = 0; bit < 27; ++bit)
        if (block[bit]) return bit;
    return -1;
}

// True if taking the middle cell away neither splits the solid, nor makes a tunnel, nor opens a cavity.
bool simple(Block solid) {
    static const std::array<Block, 27> touching = neighbour_table(false), facing = neighbour_table(true);
    static const Block within_edges = [] {
        Block eighteen;
        for (int bit = 0; bit < 27; ++bit)
            eighteen[bit] = glm::dot(vec3(place(bit)), vec3(place(bit))) < 2.5f;
        return eighteen;
    }();
    solid[middle] = false;
    if (solid.none() || reach(solid, first(solid), touching) != solid) return false;

    Block empty = ~solid & within_edges;
    empty[middle] = false;
    const Block beside = empty & facing[middle];
    if (beside.none()) return false;
    const Block outside = reach(empty, first(beside), facing);
    return (beside & ~outside).none();
}

bool beside_half_full(const Cells& cells, const std::vector<float>& inside, ivec3 c) {
    for (int bit = 0; bit < 27; ++bit)
        if (bit != middle && cells.at(c + place(bit)) && inside[cells.index(c + place(bit))] >= 0.5f)
            return true;
    return false;
}

}  // namespace

Cells fill(ivec3 dims, const std::vector<float>& inside) {
    Cells cells{dims, std::vector<std::uint8_t>(inside.size())};
    std::vector<ivec3> doubtful;
    for_each_place(dims, [&](ivec3 c) {
        const float part = inside[cells.index(c)];
        cells.filled[cells.index(c)] = part > 0;
        if (part > 0 && part < 0.5f) doubtful.push_back(c);
    });
    std::stable_sort(doubtful.begin(), doubtful.end(),
                     [&](ivec3 a, ivec3 b) { return inside[cells.index(a)] < inside[cells.index(b)]; });

    // Taking a cell away can make a neighbour simple that was not; so again until nothing changes.
    for (std::size_t before = doubtful.size() + 1; before != doubtful.size();) {
        before = doubtful.size();
        std::erase_if(doubtful, [&](ivec3 c) {
            const bool away = beside_half_full(cells, inside, c) && simple(block_around(cells, c));
            if (away) cells.filled[cells.index(c)] = 0;
            return away;
        });
    }
    return cells;
}

}  // namespace palpate
