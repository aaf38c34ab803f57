#include "palpate/mesh/tree.h"

#include "palpate/base/parallel.h"
#include "palpate/mesh/triangle.h"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

constexpr Index most_in_a_leaf = 4;

// How many nodes a tree over n faces has, and a tree over n + 1. Their halves have two sizes, which differ by
// one again, so this takes one step for each level.
std::pair<Index, Index> nodes_over(Index count) {
    if (count < most_in_a_leaf) return {1, 1};
    const auto [less, more] = nodes_over(count / 2);
    const Index even = 1 + 2 * (count % 2 == 0 ? less : more), odd = 1 + less + more;
    if (count % 2 == 1) return {odd, even};
    return {count == most_in_a_leaf ? 1 : even, odd};
}

// Since the number of nodes of a subtree is known beforehand, both subtrees are built in parallel, and the
// result does not depend on the number of threads.
class TreeBuilder {
 public:
    explicit TreeBuilder(Tree& tree) : mesh_(tree.mesh), tree_(tree), placed_(tree.faces.size()) {
        tree.nodes.resize(nodes_over(Index(tree.faces.size())).first);
        parallel_for(placed_.size(), 16384, [&](std::size_t i) {
            const uvec3 t = mesh_.triangles[tree.faces[i]];
            placed_[i] = {
                mesh_.positions[t.x] / 3.0f + mesh_.positions[t.y] / 3.0f + mesh_.positions[t.z] / 3.0f,
                tree.faces[i]};
        });
    }

    void build() { split(0, 0, Index(placed_.size())); }

 private:
    struct Placed {
        vec3 middle;
        Index face;
    };

    void split(Index node, Index first, Index count) {
        Tree::Node& here = tree_.nodes[node];
        here.first = first, here.count = count, here.second = 0;
        if (count <= most_in_a_leaf) return enclose(here);
        const Index half = count / 2;
        partition_at_median(first, count);
        here.second = node + 1 + nodes_over(half).first;
        const auto first_half = [&] { split(node + 1, first, half); };
        const auto second_half = [&] { split(here.second, first + half, count - half); };
        if (count > worth_sharing) {
            parallel_invoke(first_half, second_half);
        } else {
            first_half();
            second_half();
        }
        here.low = glm::min(tree_.nodes[node + 1].low, tree_.nodes[here.second].low);
        here.high = glm::max(tree_.nodes[node + 1].high, tree_.nodes[here.second].high);
    }

    // Partitions the faces at the median along the longest axis.
    void partition_at_median(Index first, Index count) {
        Bounds middles;
        for (Index i = first; i < first + count; ++i) middles.include(placed_[i].middle);
        const vec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto begin = placed_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count,
                         [&](const Placed& a, const Placed& b) { return a.middle[axis] < b.middle[axis]; });
    }

    // A leaf and its faces.
    void enclose(Tree::Node& leaf) {
        Bounds box;
        for (Index i = leaf.first; i < leaf.first + leaf.count; ++i) {
            tree_.faces[i] = placed_[i].face;
            const uvec3 t = mesh_.triangles[placed_[i].face];
            for (int k = 0; k < 3; ++k) box.include(mesh_.positions[t[k]]);
        }
        leaf.low = box.low, leaf.high = box.high;
    }

    static constexpr Index worth_sharing = 4096;  // faces, for a task of its own

    const Mesh& mesh_;
    Tree& tree_;
    std::vector<Placed> placed_;  // only the tree's faces, which may be few of the mesh's
};

// The squared distance from a box. Inlined because queries spend most of their time here.
[[gnu::always_inline]] inline float distance_squared(vec3 low, vec3 high, vec3 p) {
    const vec3 off = glm::max(glm::max(low - p, p - high), vec3(0));
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
    if (!faces.empty()) TreeBuilder(*this).build();
}

std::vector<Tree::Plate> Tree::plates() const {
    std::vector<Plate> plates(nodes.size());
    std::vector<double> size(nodes.size());  // m², the sum of areas regardless of orientation
    // At first `centre` is the area-weighted sum of the faces' centres.
    parallel_for(nodes.size(), 4096, [&](std::size_t i) {
        if (nodes[i].second == 0) size[i] = add_faces(nodes[i], plates[i]);
    });
    for (std::size_t i = nodes.size(); i-- > 0;) {  // children come after their parents
        if (nodes[i].second == 0) continue;
        for (const std::size_t half : {i + 1, std::size_t(nodes[i].second)}) {
            plates[i].area += plates[half].area;
            plates[i].centre += plates[half].centre;
            size[i] += size[half];
        }
    }
    parallel_for(nodes.size(), 4096, [&](std::size_t i) {
        const dvec3 low(nodes[i].low), high(nodes[i].high);
        dvec3& centre = plates[i].centre;
        centre = size[i] > 0 ? centre / size[i] : 0.5 * (low + high);
        plates[i].reach = glm::length(glm::max(high - centre, centre - low));
    });
    return plates;
}

double Tree::add_faces(const Node& leaf, Plate& plate) const {
    double size = 0;
    for (Index i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const uvec3 t = mesh.triangles[faces[i]];
        const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const dvec3 area = 0.5 * glm::cross(b - a, c - a);
        plate.area += area;
        plate.centre += glm::length(area) * (a + b + c) / 3.0;
        size += glm::length(area);
    }
    return size;
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
        // Its bounding box is tested first, which takes a tenth of the time and rules out most faces.
        if (!(distance_squared(glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c), p) < best)) return;
        const vec3 weights = nearest_weights(p, a, b, c);
        const vec3 off = weights.x * a + weights.y * b + weights.z * c - p;
        const float squared = glm::dot(off, off);
        if (squared < best) best = squared, face = other;
    };
    if (guess != none) look_at(guess);
    std::array<Wait, 64> stack;  // deeper than a tree can be
    std::size_t waiting = 0;
    auto push = [&](Index node, float squared) {
        if (squared < best) stack[waiting++] = {node, squared};
    };
    auto squared_to = [&](Index node) { return distance_squared(nodes[node].low, nodes[node].high, p); };
    if (!nodes.empty()) push(0, squared_to(0));
    while (waiting > 0) {
        const Wait wait = stack[--waiting];
        if (!(wait.squared < best)) continue;
        const Node& node = nodes[wait.node];
        if (node.second == 0) {
            for (Index i = node.first; i < node.first + node.count; ++i) look_at(faces[i]);
            continue;
        }
        // Pushes the nearer child last, so that it is visited first.
        const Wait first{wait.node + 1, squared_to(wait.node + 1)},
            second{node.second, squared_to(node.second)};
        const bool swap = first.squared < second.squared;
        for (const Wait& half : {swap ? second : first, swap ? first : second}) push(half.node, half.squared);
    }
    return {face == none ? most : std::sqrt(best), face};
}

}  // namespace palpate
