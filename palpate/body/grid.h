#pragma once
#include "palpate/base/vectors.h"

#include <span>
#include <vector>

namespace palpate {

/// A number, or -1 for none, at each place of a box in an integer grid; x runs fastest.
struct GridIndex {
    ivec3 low;
    ivec3 dims;
    std::vector<int> numbers;

    GridIndex(ivec3 lowest, ivec3 size)
        : low(lowest), dims(size), numbers(std::size_t(size.x) * size.y * size.z, -1) {}

    /// Numbers these places 0, 1, 2 … in a box that just holds them.
    explicit GridIndex(std::span<const ivec3> places) : GridIndex(places, lowest(places)) {}

    bool holds(ivec3 p) const {
        return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThan(p, low + dims));
    }
    int at(ivec3 p) const { return holds(p) ? numbers[slot(p)] : -1; }
    int& operator[](ivec3 p) { return numbers[slot(p)]; }

 private:
    GridIndex(std::span<const ivec3> places, ivec3 lowest) : GridIndex(lowest, size_from(places, lowest)) {
        for (std::size_t i = 0; i < places.size(); ++i) (*this)[places[i]] = int(i);
    }
    std::size_t slot(ivec3 p) const {
        p -= low;
        return (std::size_t(p.z) * dims.y + p.y) * dims.x + p.x;
    }
    static ivec3 lowest(std::span<const ivec3> places) {
        ivec3 low = places.empty() ? ivec3(0) : places[0];
        for (ivec3 p : places) low = glm::min(low, p);
        return low;
    }
    static ivec3 size_from(std::span<const ivec3> places, ivec3 low) {
        ivec3 size(0);
        for (ivec3 p : places) size = glm::max(size, p - low + 1);
        return size;
    }
};

/// Corner k of a cell, as seen from its lowest: x in the lowest bit, then y, then z.
constexpr ivec3 cell_corner(int k) { return {k & 1, k >> 1 & 1, k >> 2}; }

/// Calls visit(place) for every place of a box from (0, 0, 0), x fastest.
template <class Visit>
void for_each_place(ivec3 dims, Visit visit) {
    for (ivec3 p(0); p.z < dims.z; ++p.z)
        for (p.y = 0; p.y < dims.y; ++p.y)
            for (p.x = 0; p.x < dims.x; ++p.x) visit(p);
}

}  // namespace palpate
