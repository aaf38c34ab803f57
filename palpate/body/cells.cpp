#include "palpate/body/cells.h"

#include "palpate/body/grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace palpate {
namespace {

// A set of up to 64 things as bits: the 27 places of the block of 3 × 3 × 3 cells around a cell, or its 4 × 4
// × 4 points.
using Set = std::uint64_t;

constexpr int middle = 13;  // the cell itself in its block

constexpr ivec3 place(int bit) { return {bit % 3 - 1, bit / 3 % 3 - 1, bit / 9 - 1}; }
constexpr ivec3 point(int bit) { return {bit % 4, bit / 4 % 4, bit / 16}; }

// For each point, the others next to it by faces, edges and corners.
std::array<Set, 64> points_next_to_points() {
    std::array<Set, 64> table{};
    for (int a = 0; a < 64; ++a)
        for (int b = 0; b < 64; ++b) {
            const ivec3 d = glm::abs(point(a) - point(b));
            if (std::max({d.x, d.y, d.z}) == 1) table[a] |= Set(1) << b;
        }
    return table;
}

const std::array<Set, 64> next_to = points_next_to_points();

// The points of `set` that can be reached from its members `from` by steps inside it.
Set reach(Set set, Set from) {
    Set reached = from & set;
    for (Set edge = reached; edge;) {
        Set more = 0;
        for (; edge; edge &= edge - 1) more |= next_to[std::countr_zero(edge)];
        edge = more & set & ~reached;
        reached |= edge;
    }
    return reached;
}

// For each place of the block, the cell's points that lie within `depth` layers of points of it.
std::array<Set, 27> points_towards_places(int depth) {
    std::array<Set, 27> points{};
    for (int bit = 0; bit < 27; ++bit)
        for (int p = 0; p < 64; ++p) {
            bool is_near = bit != middle;
            for (int axis = 0; axis < 3; ++axis) {
                const int side = place(bit)[axis], layer = side < 0 ? point(p)[axis] : 3 - point(p)[axis];
                is_near &= side == 0 || layer < depth;
            }
            points[bit] |= Set(is_near) << p;
        }
    return points;
}

Set filled_neighbours(const Cells& cells, ivec3 c) {
    Set block = 0;
    for (int bit = 0; bit < 27; ++bit) block |= Set(bit != middle && cells.at(c + place(bit))) << bit;
    return block;
}

Set touched(const Samples& cell) { return cell.inside ? cell.inside : cell.near; }

// How much of the solid a cell holds. Points merely near the surface count less than any inside.
int amount(const Samples& cell) {
    return cell.inside ? 64 + std::popcount(cell.inside) : std::popcount(cell.near);
}

// Points within half a cell of each neighbour, and right beside it.
const std::array<Set, 27> within_half = points_towards_places(2), beside = points_towards_places(1);

// Which cells hang together, by faces, edges or corners; grows as cells are filled.
class FilledParts {
 public:
    explicit FilledParts(const Cells& cells) : cells_(cells), parent_(cells.filled.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for_each_place(cells.dims, [&](ivec3 c) {
            if (cells.at(c)) join(c);
        });
    }
    void join(ivec3 c) {
        for (Set block = filled_neighbours(cells_, c); block; block &= block - 1)
            parent_[part(c)] = part(c + place(std::countr_zero(block)));
    }
    std::size_t part(ivec3 c) {
        std::size_t i = cells_.index(c);
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

 private:
    const Cells& cells_;
    std::vector<std::size_t> parent_;
};

// The work of fill().
class Filling {
 public:
    Filling(ivec3 dims, const std::vector<Samples>& samples)
        : samples_(samples), cells_{dims, std::vector<std::uint8_t>(samples.size())} {}

    Cells run() {
        std::vector<ivec3> doubtful;
        for_each_place(cells_.dims, [&](ivec3 c) {
            if (std::popcount(at(c).inside) >= 32)
                fill(c);
            else if (touched(at(c)))
                doubtful.push_back(c);
        });
        std::stable_sort(doubtful.begin(), doubtful.end(),
                         [&](ivec3 a, ivec3 b) { return amount(at(a)) > amount(at(b)); });
        for (ivec3 c : doubtful)
            if (!covered(c)) fill(c);
        FilledParts parts(cells_);
        for (ivec3 c : doubtful)
            if (!cells_.at(c)) keep_together(c, parts);
        return std::move(cells_);
    }

 private:
    const Samples& at(ivec3 c) const { return samples_[cells_.index(c)]; }
    void fill(ivec3 c) { cells_.filled[cells_.index(c)] = 1; }

    // True if every touched point lies within half a cell of a filled neighbour.
    bool covered(ivec3 c) const {
        Set rest = touched(at(c));
        for (Set block = filled_neighbours(cells_, c); block && rest; block &= block - 1)
            rest &= ~within_half[std::countr_zero(block)];
        return rest == 0;
    }

    // The cell that stands for a group of a cell's points: itself, or the fullest neighbour within half a
    // cell of any.
    ivec3 stand_in(ivec3 c, Set group) const {
        if (cells_.at(c)) return c;
        ivec3 best = c;
        int most = -1;
        for (Set block = filled_neighbours(cells_, c); block; block &= block - 1) {
            const int bit = std::countr_zero(block);
            const ivec3 neighbour = c + place(bit);
            if (!(group & within_half[bit]) || amount(at(neighbour)) <= most) continue;
            most = amount(at(neighbour));
            best = neighbour;
        }
        return best;
    }

    // Where points of this empty cell go on in a neighbour, but what stands for the two does not hang
    // together, both cells are filled.
    void keep_together(ivec3 c, FilledParts& parts) {
        for (Set rest = touched(at(c)); rest && !cells_.at(c);) {
            const Set group = reach(rest, rest & -rest);
            rest &= ~group;
            for (int bit = 0; bit < 27; ++bit) {
                if (!(group & beside[bit])) continue;
                const ivec3 neighbour = c + place(bit);
                const Set next = continuation(c, group & beside[bit], neighbour);
                if (!next || parts.part(stand_in(c, group)) == parts.part(stand_in(neighbour, next)))
                    continue;
                for (ivec3 bridge : {c, neighbour}) {
                    fill(bridge);
                    parts.join(bridge);
                }
            }
        }
    }

    // The neighbour's touched points next to these of c's.
    Set continuation(ivec3 c, Set points, ivec3 neighbour) const {
        const bool outside = glm::any(glm::lessThan(neighbour, ivec3(0))) ||
                             glm::any(glm::greaterThanEqual(neighbour, cells_.dims));
        if (outside) return 0;
        Set next = 0;
        for (Set own = points; own; own &= own - 1)
            for (Set others = touched(at(neighbour)); others; others &= others - 1) {
                const int other = std::countr_zero(others);
                const ivec3 d = glm::abs(4 * (neighbour - c) + point(other) - point(std::countr_zero(own)));
                if (std::max({d.x, d.y, d.z}) <= 1) next |= Set(1) << other;
            }
        return next;
    }

    const std::vector<Samples>& samples_;
    Cells cells_;
};

}  // namespace

Cells fill(ivec3 dims, const std::vector<Samples>& samples) { return Filling(dims, samples).run(); }

}  // namespace palpate
