#include "palpate/mesh/pieces.h"

#include "palpate/base/parallel.h"
#include "palpate/mesh/face_pairs.h"
#include "palpate/mesh/intersections.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/triangle.h"
#include "palpate/mesh/winding_number.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace palpate {
namespace {

constexpr double touching = 1e-5;  // as a part of the longest side
// How many sample points a piece's box gets, in proportion to its volume: for the largest, but fewer if that
// would be too many in all; and for the smallest, but fewer if there are many of these.
constexpr double most_points = 60e3, most_in_all = 2e6;
constexpr double least_points = 1e3, least_of_many = 64;

std::array<dvec3, 3> corners_of(const Mesh& mesh, Index face) {
    const uvec3 t = mesh.triangles[face];
    return {dvec3(mesh.positions[t.x]), dvec3(mesh.positions[t.y]), dvec3(mesh.positions[t.z])};
}

// For each node of a tree whose faces all belong to one group, that group; none for the others.
std::vector<Index> one_part_nodes(const Tree& tree, const Parts& part) {
    std::vector<Index> of(tree.nodes.size());
    for (std::size_t node = of.size(); node-- > 0;) {  // children come after their parents
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

// Returns whether the search for touching parts was completed.
bool unite_touching(const Tree& tree, const Parts& part, Groups& groups) {
    const Mesh& mesh = tree.mesh;
    const std::vector<Index> only = one_part_nodes(tree, part);
    const vec3 size = bounds(mesh).size();
    const double reach = touching * double(std::max({size.x, size.y, size.z}));
    std::size_t tests = 0;
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
            tests += std::size_t(tree.nodes[a].count) * tree.nodes[b].count;
            return tests <= most_tests_of(mesh);
        });
}

bool holds(const Bounds& box, const Bounds& other) {
    return glm::all(glm::lessThanEqual(box.low, other.low)) &&
           glm::all(glm::lessThanEqual(other.high, box.high));
}

// Sweep and prune: bounding boxes sorted along the axis on which they overlap least.
class SortedBoxes {
 public:
    explicit SortedBoxes(const std::vector<Bounds>& boxes) : boxes_(boxes), order_(boxes.size()) {
        Bounds all;
        dvec3 sizes(0);
        for (const Bounds& box : boxes) {
            all.include(box.low);
            all.include(box.high);
            sizes += dvec3(box.size());
        }
        const dvec3 overlap = sizes / glm::max(dvec3(all.size()), std::numeric_limits<double>::min());
        axis_ = overlap.x <= overlap.y && overlap.x <= overlap.z ? 0 : overlap.y <= overlap.z ? 1 : 2;
        std::iota(order_.begin(), order_.end(), Index(0));
        std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return start(a) < start(b); });
    }

    std::vector<Index> inside(Index outer) const {
        const Bounds& box = boxes_[outer];
        std::vector<Index> held;
        auto at = std::partition_point(order_.begin(), order_.end(),
                                       [&](Index i) { return start(i) < box.low[axis_]; });
        for (; at != order_.end() && start(*at) <= box.high[axis_]; ++at)
            if (*at != outer && holds(box, boxes_[*at])) held.push_back(*at);
        return held;
    }

 private:
    float start(Index i) const { return boxes_[i].low[axis_]; }

    const std::vector<Bounds>& boxes_;
    std::vector<Index> order_;
    int axis_ = 0;
};

// Of all parts around a part, the smallest decides where it lies: in matter if that one faces outwards, or
// loose in a cavity if it faces inwards.
void unite_nested(const Mesh& mesh, const Parts& part, Groups& groups) {
    constexpr std::size_t few = 8;  // too few for a tree
    struct Around {
        Index part = none;
        double volume = std::numeric_limits<double>::max();
        bool outward = false;
    };
    const std::vector<Bounds> box = boxes(mesh, part);
    const std::vector<double> volume = volumes(mesh, part);
    const std::vector<std::vector<Index>> faces = faces_by(part.of, part.count);
    const SortedBoxes sorted(box);
    std::vector<Around> innermost(part.count);
    for (Index outer = 0; outer < part.count; ++outer) {
        const std::vector<Index> inner = sorted.inside(outer);
        if (inner.empty()) continue;
        const Tree tree(mesh, inner.size() > few ? faces[outer] : std::vector<Index>());
        const WindingNumber winding(tree);
        for (Index i : inner) {
            const auto [a, b, c] = corners_of(mesh, faces[i].front());
            const dvec3 middle = (a + b + c) / 3.0;
            const double around =
                inner.size() > few ? winding.at(middle) : exact_winding(mesh, faces[outer], middle);
            if (std::abs(around) < 0.5 || std::abs(volume[outer]) >= innermost[i].volume) continue;
            innermost[i] = {outer, std::abs(volume[outer]), around > 0};
        }
    }
    for (Index i = 0; i < part.count; ++i)
        if (innermost[i].outward) groups.unite(innermost[i].part, i);
}

// The spacing of about so many sample points in a box, in a plane if it is thinner than that, or on a line.
double spacing_of(dvec3 size, double points) {
    std::sort(&size.x, &size.x + 3);
    return std::max(
        {std::cbrt(size.x * size.y * size.z / points), std::sqrt(size.y * size.z / points), size.z / points});
}

// The volume with a winding number above a half, m³: estimated by evenly spaced points in the bounding box.
double counted_volume(const Mesh& mesh, const std::vector<Index>& faces, const Bounds& box, double points) {
    const Tree tree(mesh, faces);
    const WindingNumber winding(tree);
    const dvec3 size = box.size();
    const ivec3 dims = glm::max(ivec3(glm::ceil(size / spacing_of(size, points))), ivec3(1));
    const dvec3 step = size / dvec3(dims);
    std::atomic<std::size_t> inside = 0;
    parallel_for(std::size_t(dims.z) * dims.y, 8, [&](std::size_t row) {
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
    double largest = 0, all = 0;
    std::size_t counted = 0;
    for (Index piece = 0; piece < count; ++piece) {
        largest = std::max(largest, room(box[piece]));
        if (!count_points[piece]) continue;
        all += room(box[piece]);
        ++counted;
    }
    const double least = std::clamp(most_in_all / double(counted), least_of_many, least_points);
    parallel_for(count, 1, [&](std::size_t piece) {
        const double own = room(box[piece]);
        if (!count_points[piece] || !(own > 0)) return;
        const double points = std::max(std::min(most_points * own / largest, most_in_all * own / all), least);
        found.volume[piece] = counted_volume(mesh, faces[piece], box[piece], points);
    });
}

}  // namespace

Pieces pieces(const Mesh& mesh, const Parts& part) { return pieces(Tree(mesh), part); }

Pieces pieces(const Tree& tree, const Parts& part) {
    const Mesh& mesh = tree.mesh;
    Groups groups(part.count);
    Pieces found;
    found.all = unite_touching(tree, part, groups);
    if (found.all)
        unite_nested(mesh, part, groups);
    else
        for (Index i = 1; i < part.count; ++i) groups.unite(0, i);
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
    Arrangement arrangement(mesh);
    return keep_largest(mesh, arrangement);
}

Dropped keep_largest(Mesh& mesh, Arrangement& arrangement) {
    const Parts part = parts(mesh);
    if (part.count < 2) return {};
    const std::vector<char> turn = wrong_way_out(mesh, part, arrangement);
    turn_over(mesh, part, turn);
    const Pieces found = pieces(arrangement.tree(), part);
    turn_over(mesh, part, turn);
    if (!found.all) return {.crowded = mesh.triangles.size()};
    if (found.volume.size() < 2) return {};
    const auto largest =
        Index(std::max_element(found.volume.begin(), found.volume.end()) - found.volume.begin());
    std::vector<char> keep;
    for (Index piece : found.of) keep.push_back(piece == largest);
    Dropped dropped = keep_parts(mesh, part, keep);
    arrangement.forget();
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
