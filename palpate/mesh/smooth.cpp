#include "palpate/base/parallel.h"
#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <algorithm>
#include <vector>

namespace palpate {
namespace {

// The vertices towards which each vertex moves: all its neighbours, or at a border only those along the
// border, so that the border is smoothed as a curve and does not shrink inwards.
struct Neighbours {
    std::vector<Index> first, vertices;
};

Neighbours neighbours(const Mesh& mesh) {
    const Corners corners(mesh);
    Neighbours result;
    result.first.reserve(mesh.positions.size() + 1);
    result.vertices.reserve(3 * mesh.triangles.size());
    std::vector<Index> around, inner, border;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        around.clear(), inner.clear(), border.clear();
        for (Index c : corners.at(v)) {
            around.push_back(corners.vertex(Corners::next(c)));
            around.push_back(corners.vertex(Corners::previous(c)));
        }
        std::sort(around.begin(), around.end());
        for (auto at = around.begin(); at != around.end();) {
            auto end = std::upper_bound(at, around.end(), *at);
            (end - at == 1 ? border : inner).push_back(*at);  // a border edge has one face
            at = end;
        }
        const std::vector<Index>& chosen = border.empty() ? inner : border;
        result.first.push_back(Index(result.vertices.size()));
        result.vertices.insert(result.vertices.end(), chosen.begin(), chosen.end());
    }
    result.first.push_back(Index(result.vertices.size()));
    return result;
}

// A Laplacian step: moves every vertex by `step` of the way to the mean of its neighbours.
void move_to_mean(const Neighbours& near, float step, const std::vector<vec3>& from, std::vector<vec3>& to) {
    parallel_for(from.size(), 8192, [&](std::size_t v) {
        vec3 sum(0);
        const Index first = near.first[v], last = near.first[v + 1];
        for (Index i = first; i < last; ++i) sum += from[near.vertices[i]];
        to[v] = first == last ? from[v] : from[v] + step * (sum / float(last - first) - from[v]);
    });
}

}  // namespace

void smooth(Mesh& mesh, int passes) {
    // Taubin's pair λ, μ: the second step inflates what the first shrinks, except ripples of a few edge
    // lengths. The pass-band frequency is 1/0.5 - 1/0.53 = 0.11, near the 0.1 that he advises.
    constexpr float shrink = 0.5f, grow = -0.53f;
    if (passes <= 0) return;
    const Neighbours near = neighbours(mesh);
    std::vector<vec3> moved(mesh.positions.size());
    for (int pass = 0; pass < passes; ++pass) {
        move_to_mean(near, shrink, mesh.positions, moved);
        move_to_mean(near, grow, moved, mesh.positions);
    }
    drop_attributes(mesh);
}

}  // namespace palpate
