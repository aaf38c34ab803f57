#include "palpate/render/unit_ball.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <utility>

namespace palpate {
namespace {

Mesh icosahedron() {
    const float g = std::numbers::phi_v<float>;
    Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return mesh;
}

// Splits every edge in half, so each triangle becomes four.
void refine(Mesh& mesh) {
    std::map<std::pair<unsigned, unsigned>, unsigned> middles;
    auto middle = [&](unsigned a, unsigned b) {
        auto next = static_cast<unsigned>(mesh.positions.size());
        auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, next);
        if (is_new) mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
        return at->second;
    };
    std::vector<uvec3> finer;
    for (uvec3 t : mesh.triangles) {
        const uvec3 m(middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x));
        for (uvec3 part : {uvec3(t.x, m.x, m.z), uvec3(t.y, m.y, m.x), uvec3(t.z, m.z, m.y), m})
            finer.push_back(part);
    }
    mesh.triangles = std::move(finer);
}

}  // namespace

Mesh unit_ball() {
    Mesh mesh = icosahedron();
    for (int i = 0; i < 4; ++i) {
        for (vec3& p : mesh.positions) p = normalize(p);
        refine(mesh);
    }
    for (vec3& p : mesh.positions) p = normalize(p);
    mesh.normals = mesh.positions;
    return mesh;
}

}  // namespace palpate
