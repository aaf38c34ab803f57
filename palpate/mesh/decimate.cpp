#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

// meshoptimizer collapses edges without asking whether a tunnel or a thin neck closes, so two things are left
// where one did: a face lying on the back of another, and an edge in which two sheets touch, with four faces.
// Both are mended here; each mending takes or gives as many sides of a face in one direction as in the other,
// so a closed mesh stays closed.

namespace palpate {
namespace {

// Removes each face together with one that has the same corners and turns the other way.
void drop_flaps(Mesh& mesh) {
    struct Face {
        std::array<Index, 3> corners;  // ascending
        bool turned;                   // whether sorting them turned the face over
        Index number;
        auto operator<=>(const Face&) const = default;
    };
    std::vector<Face> faces;
    faces.reserve(mesh.triangles.size());
    for (Index number = 0; number < mesh.triangles.size(); ++number) {
        const uvec3 t = mesh.triangles[number];
        const bool turned = (t.x > t.y) ^ (t.y > t.z) ^ (t.x > t.z);
        std::array corners{t.x, t.y, t.z};
        std::sort(corners.begin(), corners.end());
        faces.push_back({corners, turned, number});
    }
    std::sort(faces.begin(), faces.end());

    std::vector<char> drop(faces.size());
    std::vector<Face> open;  // faces of the same corners that wait for their back
    for (const Face& face : faces) {
        if (!open.empty() && open.back().corners != face.corners) open.clear();
        if (!open.empty() && open.back().turned != face.turned) {
            drop[face.number] = drop[open.back().number] = true;
            open.pop_back();
        } else {
            open.push_back(face);
        }
    }
    Index number = 0;
    std::erase_if(mesh.triangles, [&](uvec3) { return drop[number++]; });
}

// What is left of v without its part along the axis.
vec3 across(vec3 axis, vec3 v) { return v - axis * (glm::dot(v, axis) / glm::dot(axis, axis)); }

// By how much one turns about the axis from one direction to another, 0 to 2 pi.
float turn(vec3 axis, vec3 from, vec3 to) {
    from = across(axis, from), to = across(axis, to);
    const float angle = std::atan2(glm::dot(glm::cross(from, to), glm::normalize(axis)), glm::dot(from, to));
    return angle < 0 ? angle + 2 * std::numbers::pi_v<float> : angle;
}

// Two faces of one sheet at an edge: the corners from which it runs up in one, down in the other.
struct Pair {
    Index up, down;
};

// Of the faces around an edge from `low` to `high`, one that runs up and the one with which it bounds matter.
Pair pair_of(const Mesh& mesh, const Corners& corners, const std::vector<Index>& up,
             const std::vector<Index>& down) {
    const vec3 low = mesh.positions[corners.vertex(up[0])];
    const vec3 axis = mesh.positions[corners.vertex(Corners::next(up[0]))] - low;
    auto apex = [&](Index corner) { return mesh.positions[corners.vertex(Corners::previous(corner))] - low; };
    auto matter = [&](Index corner) { return turn(axis, apex(corner), apex(up[0])); };
    return {up[0], *std::min_element(down.begin(), down.end(),
                                     [&](Index a, Index b) { return matter(a) < matter(b); })};
}

// One pair for each edge in which several sheets touch; no two of them share a face.
std::vector<Pair> touching(const Mesh& mesh) {
    struct Side {
        Index other, corner;
        bool up;
    };
    const Corners corners(mesh);
    std::vector<Pair> found;
    std::vector<char> taken(mesh.triangles.size());
    std::vector<Side> sides;
    std::vector<Index> up, down;
    for (Index v = 0; v < mesh.positions.size(); ++v) {
        sides.clear();
        for (Index c : corners.at(v)) {
            sides.push_back({corners.vertex(Corners::next(c)), c, true});
            sides.push_back({corners.vertex(Corners::previous(c)), Corners::previous(c), false});
        }
        std::erase_if(sides, [&](Side side) { return side.other < v; });
        std::sort(sides.begin(), sides.end(), [](Side a, Side b) { return a.other < b.other; });
        for (std::size_t i = 0; i < sides.size();) {
            up.clear(), down.clear();
            for (const Index other = sides[i].other; i < sides.size() && sides[i].other == other; ++i)
                (sides[i].up ? up : down).push_back(sides[i].corner);
            if (up.size() < 2 || down.size() < 2) continue;
            const Pair pair = pair_of(mesh, corners, up, down);
            if (taken[pair.up / 3] || taken[pair.down / 3]) continue;
            taken[pair.up / 3] = taken[pair.down / 3] = true;
            found.push_back(pair);
        }
    }
    return found;
}

// Cuts a face in two, from the middle of the side that begins at `corner` to the corner across.
void cut_side(Mesh& mesh, Index corner, Index middle) {
    uvec3 far_half = mesh.triangles[corner / 3];
    far_half[corner % 3] = middle;
    mesh.triangles[corner / 3][Corners::next(corner) % 3] = middle;
    mesh.triangles.push_back(far_half);
}

// Where several sheets touch in one edge, gives each its own: all but one get a new vertex in its middle.
void part_sheets(Mesh& mesh) {
    for (std::vector<Pair> pairs = touching(mesh); !pairs.empty(); pairs = touching(mesh))
        for (Pair pair : pairs) {
            const uvec3 face = mesh.triangles[pair.up / 3];
            const vec3 a = mesh.positions[face[pair.up % 3]],
                       b = mesh.positions[face[Corners::next(pair.up) % 3]];
            const auto middle = Index(mesh.positions.size());
            mesh.positions.push_back(0.5f * (a + b));
            cut_side(mesh, pair.up, middle);
            cut_side(mesh, pair.down, middle);
        }
}

}  // namespace

std::size_t decimate(Mesh& mesh, std::size_t faces) {
    const std::size_t before = mesh.triangles.size();
    if (before <= faces) return 0;
    // The number of faces decides, so any error is allowed: 1 is as much as the whole mesh is wide.
    std::vector<uvec3> kept(before);
    const std::size_t indices =
        meshopt_simplify(&kept[0].x, &mesh.triangles[0].x, 3 * before, &mesh.positions[0].x,
                         mesh.positions.size(), sizeof(vec3), 3 * faces, 1.0f, 0, nullptr);
    kept.resize(indices / 3);
    mesh.triangles = std::move(kept);
    mesh.normals.clear();
    drop_flaps(mesh);
    part_sheets(mesh);
    drop_unused(mesh);
    return before - mesh.triangles.size();
}

}  // namespace palpate
