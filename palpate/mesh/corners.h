#pragma once
#include "palpate/mesh/mesh.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

using Index = std::uint32_t;
constexpr Index none = ~Index(0);

/// A corner table (half-edges): the faces that meet at each vertex. Corner 3f + k is corner k of face f.
class Corners {
 public:
    explicit Corners(const Mesh& mesh) : triangles_(mesh.triangles), first_(mesh.positions.size() + 1) {
        for (uvec3 t : triangles_)
            for (int k = 0; k < 3; ++k) ++first_[t[k] + 1];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        corners_.resize(3 * triangles_.size());
        std::vector<Index> place(first_.begin(), first_.end() - 1);
        for (Index corner = 0; corner < corners_.size(); ++corner) corners_[place[vertex(corner)]++] = corner;
    }

    std::span<const Index> at(std::size_t vertex) const {
        return std::span(corners_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    std::size_t vertices() const { return first_.size() - 1; }
    Index vertex(Index corner) const { return triangles_[corner / 3][corner % 3]; }

    /// The next and the previous corner of the same face.
    static Index next(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static Index previous(Index corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

 private:
    const std::vector<uvec3>& triangles_;
    std::vector<Index> first_;    // where each vertex's corners begin
    std::vector<Index> corners_;  // by vertex
};

/// A half-edge: the side of a face along an edge. An edge is stored at its vertex of lower number.
struct Side {
    Index other;   // the edge's vertex of higher number
    Index corner;  // the corner of its face where the side begins
    bool up;       // whether it runs from the lower vertex number to the higher

    /// The face's corners at the edge's two ends.
    Index low() const { return up ? corner : Corners::next(corner); }
    Index high() const { return up ? Corners::next(corner) : corner; }
};

/// Calls f(lower vertex, sides) once for each edge, with the sides of all faces along it. The two sides of a
/// collapsed face, from a vertex to itself, count as an edge of their own.
template <class F>
void for_each_edge(const Corners& corners, F f) {
    std::vector<Side> sides;
    for (Index v = 0; v < corners.vertices(); ++v) {
        sides.clear();
        for (Index c : corners.at(v)) {
            sides.push_back({corners.vertex(Corners::next(c)), c, true});
            sides.push_back({corners.vertex(Corners::previous(c)), Corners::previous(c), false});
        }
        std::erase_if(sides, [&](Side side) { return side.other < v; });
        std::sort(sides.begin(), sides.end(), [](Side a, Side b) { return a.other < b.other; });
        for (auto from = sides.begin(); from != sides.end();) {
            const auto to =
                std::find_if(from, sides.end(), [&](Side side) { return side.other != from->other; });
            f(v, std::span<const Side>(from, to));
            from = to;
        }
    }
}

/// Disjoint sets (union-find); each set is known by one of its members.
class Groups {
 public:
    explicit Groups(std::size_t members) : parent_(members) {
        for (Index i = 0; i < members; ++i) parent_[i] = i;
    }
    Index of(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];  // path halving
        return i;
    }
    void unite(Index i, Index j) { parent_[of(j)] = of(i); }

 private:
    std::vector<Index> parent_;
};

/// For each corner, its half-edge's twin: the corner from which the neighbouring face runs along the same
/// edge in the opposite direction; none at a border. On a non-manifold edge, twins are faces with matter and
/// no other face between them.
std::vector<Index> twins(const Mesh& mesh);

/// Whether a face is degenerate: its corners are collinear, or so nearly that rounding decides on which side
/// of a line the third lies.
inline bool is_flat(const Mesh& mesh, uvec3 t) {
    const dvec3 a(mesh.positions[t.x]), ab = dvec3(mesh.positions[t.y]) - a,
                                        ac = dvec3(mesh.positions[t.z]) - a, bc = ac - ab;
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    return glm::length(glm::cross(ab, ac)) <= 1e-6 * longest;
}

/// The area of a face, m².
inline double face_area(const Mesh& mesh, uvec3 t) {
    const dvec3 a(mesh.positions[t.x]);
    return 0.5 * glm::length(glm::cross(dvec3(mesh.positions[t.y]) - a, dvec3(mesh.positions[t.z]) - a));
}

/// Drops the attributes that become invalid when vertices or positions change.
inline void drop_attributes(Mesh& mesh) {
    mesh.normals.clear();
    mesh.uvs.clear();
    mesh.tangents.clear();
}

/// Keeps the first `count` positions, and renumbers the faces' vertices by `place`, the new number of each
/// old vertex. Returns how many vertices were removed.
inline std::size_t renumber(Mesh& mesh, const std::vector<Index>& place, Index count) {
    const std::size_t removed = mesh.positions.size() - count;
    if (removed == 0) return 0;
    mesh.positions.resize(count);
    drop_attributes(mesh);
    for (uvec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
    return removed;
}

}  // namespace palpate
