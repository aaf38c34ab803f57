#include "palpate/mesh/tree.h"

#include "palpate/mesh/triangle.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

constexpr Index most_in_a_leaf = 4;

class Halving {
 public:
    Halving(const Mesh& mesh, Tree& tree) : mesh_(mesh), tree_(tree) {
        placed_.reserve(tree.faces.size());
        for (Index face : tree.faces) {
            const uvec3 t = mesh.triangles[face];
            placed_.push_back(
                {mesh.positions[t.x] / 3.0f + mesh.positions[t.y] / 3.0f + mesh.positions[t.z] / 3.0f, face});
        }
    }

    void halve_all() {
        halve(0, Index(placed_.size()));
        for (std::size_t i = 0; i < placed_.size(); ++i) tree_.faces[i] = placed_[i].face;
    }

 private:
    struct Placed {
        vec3 middle;
        Index face;
    };

    void halve(Index first, Index count) {
        const std::size_t here = tree_.nodes.size();
        Bounds box, middle;
        for (Index i = first; i < first + count; ++i) {
            const uvec3 t = mesh_.triangles[placed_[i].face];
            for (int k = 0; k < 3; ++k) box.include(mesh_.positions[t[k]]);
            middle.include(placed_[i].middle);
        }
        tree_.nodes.push_back({box.low, box.high, first, count, 0});
        if (count <= most_in_a_leaf) return;
        const vec3 size = middle.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto begin = placed_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count,
                         [&](const Placed& a, const Placed& b) { return a.middle[axis] < b.middle[axis]; });
        halve(first, count / 2);
        tree_.nodes[here].second = Index(tree_.nodes.size());
        halve(first + count / 2, count - count / 2);
    }

    const Mesh& mesh_;
    Tree& tree_;
    std::vector<Placed> placed_;  // only the tree's own, which may be few of the mesh
};

float distance_squared(const Tree::Node& node, vec3 p) {
    const vec3 off = glm::max(glm::max(node.low - p, p - node.high), vec3(0));
    return glm::dot(off, off);
}

std::vector<Index> all_faces(const Mesh& mesh) {
    std::vector<Index> faces(mesh.triangles.size());
    std::iota(faces.begin(), faces.end(), Index(0));
    return faces;
}

}  // namespace

Tree::Tree(const Mesh& all) : Tree(all, all_faces(all)) {}

Tree::Tree(const Mesh& all, std::vector<Index> some) : faces(std::move(some)), mesh(all) {
    nodes.reserve(faces.size());
    if (!faces.empty()) Halving(mesh, *this).halve_all();
}

std::vector<Tree::Plate> Tree::plates() const {
    std::vector<Plate> result(nodes.size());
    tbb::parallel_for(std::size_t(0), nodes.size(), [&](std::size_t i) { result[i] = plate(nodes[i]); });
    return result;
}

Tree::Plate Tree::plate(const Node& node) const {
    Plate plate{};
    double size = 0;
    for (Index i = node.first; i < node.first + node.count; ++i) {
        const uvec3 t = mesh.triangles[faces[i]];
        const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const dvec3 area = 0.5 * glm::cross(b - a, c - a);
        plate.area += area;
        plate.centre += glm::length(area) * (a + b + c) / 3.0;
        size += glm::length(area);
    }
    const dvec3 low(node.low), high(node.high);
    plate.centre = size > 0 ? plate.centre / size : 0.5 * (low + high);
    plate.reach = glm::length(glm::max(high - plate.centre, plate.centre - low));
    plate.thickness = std::numeric_limits<double>::infinity();
    const double length = glm::length(plate.area);
    if (length == 0) return plate;
    plate.thickness = 0;
    for (Index i = node.first; i < node.first + node.count; ++i)
        for (int k = 0; k < 3; ++k) {
            const dvec3 corner(mesh.positions[mesh.triangles[faces[i]][k]]);
            plate.thickness =
                std::max(plate.thickness, std::abs(glm::dot(plate.area, corner - plate.centre)) / length);
        }
    return plate;
}

Tree::Nearest Tree::nearest(vec3 p, float most, Index guess) const {
    struct Wait {
        Index node;
        float squared;
    };
    float best = most * most;
    Index face = none;
    auto look_at = [&](Index other) {
        const uvec3 t = mesh.triangles[other];
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 weights = nearest_weights(p, a, b, c);
        const vec3 off = weights.x * a + weights.y * b + weights.z * c - p;
        const float squared = glm::dot(off, off);
        if (squared < best) best = squared, face = other;
    };
    if (guess != none) look_at(guess);
    std::vector<Wait> stack;
    auto push = [&](Index node) {
        const float squared = distance_squared(nodes[node], p);
        if (squared < best) stack.push_back({node, squared});
    };
    if (!nodes.empty()) push(0);
    while (!stack.empty()) {
        const Wait wait = stack.back();
        stack.pop_back();
        if (!(wait.squared < best)) continue;
        const Node& node = nodes[wait.node];
        if (node.second == 0) {
            for (Index i = node.first; i < node.first + node.count; ++i) look_at(faces[i]);
            continue;
        }
        // The nearer half last, so that it is looked at first.
        const bool swap = distance_squared(nodes[wait.node + 1], p) < distance_squared(nodes[node.second], p);
        push(swap ? node.second : wait.node + 1);
        push(swap ? wait.node + 1 : node.second);
    }
    return {face == none ? most : std::sqrt(best), face};
}

}  // namespace palpate
