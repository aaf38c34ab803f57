#include "palpate/base/error.h"
#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <unordered_map>
#include <vector>

namespace palpate {
namespace {

struct HashPlace {
    std::size_t operator()(dvec3 p) const {
        std::size_t hash = 0;
        for (int k = 0; k < 3; ++k)  // + 0.0 makes -0 and 0, which are equal, hash alike
            hash = (hash ^ std::hash<double>()(p[k] + 0.0)) * 0x9e3779b97f4a7c15u;
        return hash ^ (hash >> 32);
    }
};

// The kept vertices in a hash grid: its cells are twice as wide as the tolerance, so everything near a point
// lies in at most eight of them. With tolerance 0, each place is its own cell.
class Kept {
 public:
    Kept(const std::vector<vec3>& positions, float tolerance)
        : positions_(positions), tolerance_(tolerance), below_(positions.size(), none) {
        top_.reserve(positions.size());
    }

    Index find(vec3 p) const {
        const dvec3 low = cell(dvec3(p) - double(tolerance_)), high = cell(dvec3(p) + double(tolerance_));
        const ivec3 last(glm::notEqual(low, high));
        for (int z = 0; z <= last.z; ++z)
            for (int y = 0; y <= last.y; ++y)
                for (int x = 0; x <= last.x; ++x) {
                    auto found = top_.find(glm::mix(low, high, glm::bvec3(x, y, z)));
                    for (Index v = found == top_.end() ? none : found->second; v != none; v = below_[v])
                        if (glm::distance(positions_[v], p) <= tolerance_) return v;
                }
        return none;
    }

    void add(Index v) {
        Index& top = top_.try_emplace(cell(dvec3(positions_[v])), none).first->second;
        below_[v] = top;
        top = v;
    }

 private:
    dvec3 cell(dvec3 p) const { return tolerance_ > 0 ? glm::floor(p / (2.0 * tolerance_)) : p; }

    const std::vector<vec3>& positions_;
    float tolerance_;
    std::unordered_map<dvec3, Index, HashPlace> top_;  // the last vertex added to each cell
    std::vector<Index> below_;                         // the vertex added to the same cell before
};

// Welds the vertices for which `chosen` is true, each to an earlier one.
template <class F>
std::size_t weld_chosen(Mesh& mesh, float tolerance, F chosen) {
    if (!(tolerance >= 0))
        throw Error("a tolerance that is negative or not a number", "welding", "use 0 or more, in m");
    Kept kept(mesh.positions, tolerance);
    std::vector<Index> place(mesh.positions.size());
    Index count = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        place[v] = chosen(v) ? kept.find(mesh.positions[v]) : none;
        if (place[v] != none) continue;
        mesh.positions[count] = mesh.positions[v];
        if (chosen(v)) kept.add(count);
        place[v] = count++;
    }
    return renumber(mesh, place, count);
}

}  // namespace

std::vector<Index> first_in_place(const std::vector<vec3>& positions) {
    Kept kept(positions, 0);
    std::vector<Index> first(positions.size());
    for (Index v = 0; v < first.size(); ++v) {
        first[v] = kept.find(positions[v]);
        if (first[v] != none) continue;
        kept.add(v);
        first[v] = v;
    }
    return first;
}

std::size_t weld(Mesh& mesh, float tolerance) {
    return weld_chosen(mesh, tolerance, [](std::size_t) { return true; });
}

std::size_t weld_border(Mesh& mesh, float tolerance) {
    std::vector<char> border(mesh.positions.size());
    for_each_edge(Corners(mesh), [&](Index low, std::span<const Side> sides) {
        if (sides.size() == 1) border[low] = border[sides[0].other] = true;
    });
    return weld_chosen(mesh, tolerance, [&](std::size_t v) { return border[v]; });
}

}  // namespace palpate
