#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <cmath>
#include <utility>

namespace palpate {
namespace {

// The dihedral angle of a face about an edge, from an arbitrary fixed direction: -pi to pi.
class TurnAboutEdge {
 public:
    explicit TurnAboutEdge(dvec3 axis) {
        const dvec3 a = glm::abs(axis);  // a direction that is not nearly parallel to the axis
        const dvec3 off(a.x <= a.y && a.x <= a.z, a.y < a.x && a.y <= a.z, a.z < a.x && a.z < a.y);
        from_ = glm::cross(off, axis);
        side_ = glm::cross(axis, from_) / glm::length(axis);
    }
    double operator()(dvec3 way) const { return std::atan2(glm::dot(way, side_), glm::dot(way, from_)); }

 private:
    dvec3 from_, side_;
};

// Pairs twins at an edge of many sides, sorted by angle. There is matter between a side that runs down and
// the next that runs up, so these two are matched like brackets, with nesting. It goes round twice, because a
// circle has no beginning.
void pair_by_angle(const Mesh& mesh, Index low, std::span<const Side> sides, std::vector<Index>& twin) {
    const dvec3 foot(mesh.positions[low]);
    const TurnAboutEdge turn(dvec3(mesh.positions[sides[0].other]) - foot);
    std::vector<std::pair<double, Side>> round;
    for (Side side : sides) {
        const uvec3 t = mesh.triangles[side.corner / 3];
        const dvec3 apex(mesh.positions[t[Corners::previous(side.corner) % 3]]);
        round.emplace_back(turn(apex - foot), side);
    }
    std::stable_sort(round.begin(), round.end(), [](auto& a, auto& b) { return a.first < b.first; });
    std::vector<Index> open;
    open.reserve(sides.size());
    auto go_round = [&](bool again) {
        for (auto& [angle, side] : round) {
            if (twin[side.corner] != none) continue;
            if (!side.up) {
                if (!again) open.push_back(side.corner);
            } else if (!open.empty()) {
                twin[side.corner] = open.back();
                twin[open.back()] = side.corner;
                open.pop_back();
            }
        }
    };
    go_round(false);
    go_round(true);
}

// Gives each fan of faces around a vertex its own copy of the vertex; the first keeps the original.
void separate_vertices(Mesh& mesh, const std::vector<Index>& twin) {
    Groups fans(twin.size());
    for (Index corner = 0; corner < twin.size(); ++corner) {
        if (twin[corner] == none) continue;
        fans.unite(corner, Corners::next(twin[corner]));
        fans.unite(Corners::next(corner), twin[corner]);
    }
    std::vector<char> kept(mesh.positions.size());
    std::vector<Index> vertex;  // by fan
    vertex.resize(twin.size(), none);
    for (Index corner = 0; corner < twin.size(); ++corner) {
        unsigned& at = mesh.triangles[corner / 3][corner % 3];
        const Index fan = fans.of(corner);
        if (vertex[fan] == none && !kept[at]) {
            vertex[fan] = at;
            kept[at] = true;
        } else if (vertex[fan] == none) {
            vertex[fan] = Index(mesh.positions.size());
            mesh.positions.push_back(vec3(mesh.positions[at]));
        }
        at = vertex[fan];
    }
}

// Splits a face in two, from `middle` on the side that begins at `corner` to the opposite corner.
void cut_side(Mesh& mesh, Index corner, Index middle) {
    uvec3 far_half = mesh.triangles[corner / 3];
    far_half[corner % 3] = middle;
    mesh.triangles[corner / 3][Corners::next(corner) % 3] = middle;
    mesh.triangles.push_back(far_half);
}

// A fan may meet the same edge twice, at both of its ends: then copying the ends does not separate it. There
// all sheets but one get a vertex at the midpoint of the edge; but each face only once, because its indices
// change.
void separate_edges(Mesh& mesh, const std::vector<Index>& twin) {
    std::vector<Index> sides;  // one side of each sheet
    std::vector<char> taken(mesh.triangles.size());
    for_each_edge(Corners(mesh), [&](Index, std::span<const Side> all) {
        if (all.size() < 3) return;
        for (Side side : all.subspan(1)) {
            const Index face = side.corner / 3, other = twin[side.corner] / 3;
            if (twin[side.corner] == all[0].corner || taken[face]) continue;
            if (twin[side.corner] != none && std::exchange(taken[other], true)) continue;
            taken[face] = true;
            sides.push_back(side.corner);
        }
    });
    for (Index corner : sides) {
        const uvec3 face = mesh.triangles[corner / 3];
        const vec3 a = mesh.positions[face[corner % 3]], b = mesh.positions[face[Corners::next(corner) % 3]];
        const auto middle = Index(mesh.positions.size());
        mesh.positions.push_back(0.5f * a + 0.5f * b);
        cut_side(mesh, corner, middle);
        if (twin[corner] != none) cut_side(mesh, twin[corner], middle);
    }
}

}  // namespace

std::vector<Index> twins(const Mesh& mesh) {
    std::vector<Index> twin(3 * mesh.triangles.size(), none);
    for_each_edge(Corners(mesh), [&](Index low, std::span<const Side> sides) {
        if (sides[0].other == low || sides.size() == 1) return;
        if (sides.size() > 2) {
            pair_by_angle(mesh, low, sides, twin);
        } else if (sides[0].up != sides[1].up) {
            twin[sides[0].corner] = sides[1].corner;
            twin[sides[1].corner] = sides[0].corner;
        }
    });
    return twin;
}

std::size_t separate_sheets(Mesh& mesh) {
    const std::size_t before = mesh.positions.size();
    for (std::size_t last = 0; last != mesh.positions.size();) {
        last = mesh.positions.size();
        const std::vector<Index> twin = twins(mesh);
        separate_vertices(mesh, twin);
        separate_edges(mesh, twin);
    }
    if (mesh.positions.size() > before) drop_attributes(mesh);
    return mesh.positions.size() - before;
}

}  // namespace palpate
