#include "palpate/mesh/pieces.h"

#include "palpate/mesh/face_pairs.h"
#include "palpate/mesh/intersections.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/triangle.h"
#include "palpate/mesh/winding_number.h"

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <cmath>

namespace palpate {
namespace {

constexpr double touching = 1e-5;     // of the longest side
constexpr double most_points = 60e3;  // counted in the box around all pieces
constexpr double least_points = 1e3;  // and in that of any one

std::vector<std::vector<Index>> faces_by(const std::vector<Index>& group_of_face, Index groups) {
    std::vector<std::vector<Index>> faces(groups);
    for (Index face = 0; face < group_of_face.size(); ++face) faces[group_of_face[face]].push_back(face);
    return faces;
}

std::array<dvec3, 3> corners_of(const Mesh& mesh, Index face) {
    const uvec3 t = mesh.triangles[face];
    return {dvec3(mesh.positions[t.x]), dvec3(mesh.positions[t.y]), dvec3(mesh.positions[t.z])};
}

// A group for each node of a tree whose faces are all of one; none for the others.
std::vector<Index> one_part_nodes(const Tree& tree, const Parts& part) {
    std::vector<Index> of(tree.nodes.size());
    for (std::size_t node = of.size(); node-- > 0;) {  // halves stand behind what they are halves of
        const Tree::Node& box = tree.nodes[node];
        of[node] = part.of[tree.faces[box.first]];
        if (box.second != 0)
            of[node] = of[node + 1] == of[box.second] ? of[box.second] : none;
        else
            for (Index i = box.first; i < box.first + box.count; ++i)
                if (part.of[tree.faces[i]] != of[node]) of[node] = none;
    }
    return of;
}

// Returns whether all that may touch was looked at.
bool unite_touching(const Mesh& mesh, const Parts& part, Groups& groups) {
    const Tree tree(mesh);
    const std::vector<Index> only = one_part_nodes(tree, part);
    const vec3 size = bounds(mesh).size();
    const double reach = touching * double(std::max({size.x, size.y, size.z}));
    std::size_t looks = 0;
    return for_each_pair_of_leaves(
        tree, float(reach),
        [&](Index a, Index b) {
            return only[a] != none && only[b] != none && groups.of(only[a]) == groups.of(only[b]);
        },
        [&](Index a, Index b) {
            for_each_pair_of_faces(tree, a, b, [&](Index i, Index j) {
                const Index face = tree.faces[i], other = tree.faces[j];
                if (groups.of(part.of[face]) == groups.of(part.of[other])) return;
                if (are_near(corners_of(mesh, face), corners_of(mesh, other), reach))
                    groups.unite(part.of[face], part.of[other]);
            });
            looks += std::size_t(tree.nodes[a].count) * tree.nodes[b].count;
            return looks <= most_looks_at(mesh);
        });
}

bool holds(const Bounds& box, const Bounds& other) {
    return glm::all(glm::lessThanEqual(box.low, other.low)) &&
           glm::all(glm::lessThanEqual(other.high, box.high));
}

// Of all parts that wind around a part the smallest says where it lies: in matter if that winds outward, and
// in a cavity, loose, if inward.
void unite_nested(const Mesh& mesh, const Parts& part, Groups& groups) {
    struct Around {
        Index part = none;
        double volume = std::numeric_limits<double>::max();
        bool outward = false;
    };
    const std::vector<Bounds> box = boxes(mesh, part);
    const std::vector<double> volume = volumes(mesh, part);
    const std::vector<std::vector<Index>> faces = faces_by(part.of, part.count);
    std::vector<Around> innermost(part.count);
    for (Index outer = 0; outer < part.count; ++outer) {
        std::vector<Index> inner;
        for (Index i = 0; i < part.count; ++i)
            if (i != outer && holds(box[outer], box[i])) inner.push_back(i);
        if (inner.empty()) continue;
        const Tree tree(mesh, faces[outer]);
        const WindingNumber winding(tree);
        for (Index i : inner) {
            const auto [a, b, c] = corners_of(mesh, faces[i].front());
            const double around = winding.at((a + b + c) / 3.0);
            if (std::abs(around) < 0.5 || std::abs(volume[outer]) >= innermost[i].volume) continue;
            innermost[i] = {outer, std::abs(volume[outer]), around > 0};
        }
    }
    for (Index i = 0; i < part.count; ++i)
        if (innermost[i].outward) groups.unite(innermost[i].part, i);
}

// The volume that faces wind around more than half, m³: of points evenly spread in their box those inside.
double counted_volume(const Mesh& mesh, const std::vector<Index>& faces, const Bounds& box, double spacing) {
    const Tree tree(mesh, faces);
    const WindingNumber winding(tree);
    const dvec3 size = box.size();
    const ivec3 dims = glm::max(ivec3(glm::ceil(size / spacing)), ivec3(1));
    const dvec3 step = size / dvec3(dims);
    std::atomic<std::size_t> inside = 0;
    tbb::parallel_for(0, dims.z * dims.y, [&](int row) {
        std::size_t in_row = 0;
        for (int x = 0; x < dims.x; ++x)
            in_row += winding.at(dvec3(box.low) + step * (dvec3(x, row % dims.y, row / dims.y) + 0.5)) > 0.5;
        inside += in_row;
    });
    return double(inside) * step.x * step.y * step.z;
}

std::vector<char> is_open(const Mesh& mesh, const Parts& part) {
    std::vector<char> open(part.count);
    for_each_edge(Corners(mesh), [&](Index, std::span<const Side> sides) {
        if (sides.size() == 1) open[part.of[sides[0].corner / 3]] = true;
    });
    return open;
}

void measure(const Mesh& mesh, const Parts& part, Pieces& found) {
    const auto count = Index(found.volume.size());
    std::vector<Bounds> box(count);
    std::vector<int> outward(count);  // parts
    std::vector<char> count_points(count);
    const std::vector<Bounds> part_box = boxes(mesh, part);
    const std::vector<double> volume = volumes(mesh, part);
    const std::vector<char> open = is_open(mesh, part);
    for (Index i = 0; i < part.count; ++i) {
        const Index piece = found.of[i];
        box[piece].include(part_box[i].low);
        box[piece].include(part_box[i].high);
        found.volume[piece] += volume[i];
        outward[piece] += volume[i] > 0;
        count_points[piece] |= open[i] || outward[piece] > 1;
    }
    std::vector<Index> piece_of_face;
    for (Index i : part.of) piece_of_face.push_back(found.of[i]);
    const std::vector<std::vector<Index>> faces = faces_by(piece_of_face, count);
    const auto room = [](const Bounds& one) {
        const dvec3 size = one.size();
        return size.x * size.y * size.z;
    };
    double largest = 0;
    for (const Bounds& one : box) largest = std::max(largest, room(one));
    for (Index piece = 0; piece < count; ++piece) {
        if (!count_points[piece] || !(room(box[piece]) > 0)) continue;
        const double points = std::max(most_points * room(box[piece]) / largest, least_points);
        found.volume[piece] =
            counted_volume(mesh, faces[piece], box[piece], std::cbrt(room(box[piece]) / points));
    }
}

}  // namespace

Pieces pieces(const Mesh& mesh, const Parts& part) {
    Groups groups(part.count);
    if (!unite_touching(mesh, part, groups)) {
        for (Index i = 1; i < part.count; ++i) groups.unite(0, i);
    } else {
        unite_nested(mesh, part, groups);
    }
    Pieces found;
    std::vector<Index> number(part.count, none);
    for (Index i = 0; i < part.count; ++i) {
        Index& piece = number[groups.of(i)];
        if (piece == none) {
            piece = Index(found.volume.size());
            found.volume.push_back(0);
        }
        found.of.push_back(piece);
    }
    if (found.volume.size() > 1) measure(mesh, part, found);
    return found;
}

Dropped keep_largest(Mesh& mesh) {
    const Parts part = parts(mesh);
    if (part.count < 2) return {};
    Mesh turned{mesh.positions, {}, mesh.triangles};
    turn_parts(turned);
    const Pieces found = pieces(turned, part);
    if (found.volume.size() < 2) return {};
    const auto largest =
        Index(std::max_element(found.volume.begin(), found.volume.end()) - found.volume.begin());
    std::vector<char> keep;
    for (Index piece : found.of) keep.push_back(piece == largest);
    Dropped dropped = keep_parts(mesh, part, keep);
    dropped.volume = 0;
    for (Index piece = 0; piece < found.volume.size(); ++piece)
        if (piece != largest) dropped.volume += found.volume[piece];
    return dropped;
}

Dropped keep_largest_sheet(Mesh& mesh) {
    const Parts part = parts(mesh);
    if (part.count < 2) return {};
    const std::vector<double> area = areas(mesh, part);
    std::vector<char> keep(part.count);
    keep[std::size_t(std::max_element(area.begin(), area.end()) - area.begin())] = true;
    return keep_parts(mesh, part, keep);
}

}  // namespace palpate
