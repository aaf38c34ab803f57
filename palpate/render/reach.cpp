#include "palpate/render/reach.h"

#include <algorithm>

namespace palpate {
namespace {

// The vectors from anchors to their vertices.

std::vector<vec3> ways(const Mesh&, const Embedding& embedding, const std::vector<InCell>& vertices) {
    std::vector<vec3> list;
    for (const InCell& v : vertices) list.push_back(embedding.edges * (v.at - clamp(v.at, vec3(0), vec3(1))));
    return list;
}

// The part of the offset along the normal, which is nearly all of it; the rest is given in a basis that is
// unknown here.
std::vector<vec3> ways(const Mesh& mesh, const Embedding&, const std::vector<OnTriangle>& vertices) {
    std::vector<vec3> normals = mesh.normals;
    if (normals.size() != mesh.positions.size()) compute_normals(mesh.positions, mesh.triangles, normals);
    std::vector<vec3> list;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        list.push_back(dot(vertices[i].offset, vertices[i].normal) * normals[i]);
    return list;
}

std::vector<vec3> ways(const Mesh&, const Embedding&, const Framed& framed) {
    std::vector<vec3> list;
    for (const OnFrames& v : framed.vertices)
        list.push_back(v.weights.x * v.arms[0] + v.weights.y * v.arms[1] + v.weights.z * v.arms[2]);
    return list;
}

}  // namespace

Reach reach(const Mesh& mesh, const Embedding& embedding) {
    const std::vector<vec3> list =
        std::visit([&](const auto& vertices) { return ways(mesh, embedding, vertices); }, embedding.vertices);
    Reach reach;
    Bounds surface, under;
    for (std::size_t i = 0; i < list.size(); ++i) {
        surface.include(mesh.positions[i]);
        under.include(mesh.positions[i] - list[i]);
        reach.beyond = std::max(reach.beyond, length(list[i]));
    }
    const float width = length(under.size());
    if (width > 0) reach.growth = std::max(length(surface.size()) / width, 1.0f);
    return reach;
}

Bounds Reach::around(const Bounds& nodes) const {
    if (nodes.empty()) return nodes;
    const vec3 inner = 0.5f * nodes.size(), half = min(max(growth * inner, vec3(beyond)), inner + beyond);
    return {nodes.centre() - half, nodes.centre() + half};
}

}  // namespace palpate
