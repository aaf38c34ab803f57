#include "palpate/render/reach.h"

#include <algorithm>
#include <unordered_map>

namespace palpate {
namespace {

vec3 corner(std::size_t k) { return vec3(k & 1, k >> 1 & 1, k >> 2 & 1); }

}  // namespace

float cell_width(const Mesh& mesh, const std::vector<InCell>& vertices) {
    std::unordered_map<int, std::pair<vec3, vec3>>
        seen;  // for a node, a vertex: where it is, and from the node
    double metres = 0, cells = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (std::size_t k = 0; k < 8; ++k) {
            const vec3 place = mesh.positions[i], from_node = vertices[i].at - corner(k);
            const auto [other, is_new] = seen.try_emplace(vertices[i].nodes[k], place, from_node);
            if (is_new) continue;
            metres += distance(place, other->second.first);
            cells += distance(from_node, other->second.second);
        }
    return cells > 0 ? float(metres / cells) : 0;
}

namespace {

// From the places under vertices, on the nodes' side, to the vertices.

std::vector<vec3> ways(const Mesh& mesh, const std::vector<InCell>& vertices) {
    const float metres = cell_width(mesh, vertices);
    std::vector<vec3> list;
    for (const InCell& v : vertices) list.push_back(metres * (v.at - clamp(v.at, vec3(0), vec3(1))));
    return list;
}

// Of the offset, which is known in a basis that is not, the part along the normal, which nearly all of it is.
std::vector<vec3> ways(const Mesh& mesh, const std::vector<OnTriangle>& vertices) {
    std::vector<vec3> normals = mesh.normals;
    if (normals.size() != mesh.positions.size()) compute_normals(mesh.positions, mesh.triangles, normals);
    std::vector<vec3> list;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        list.push_back(dot(vertices[i].offset, vertices[i].normal) * normals[i]);
    return list;
}

std::vector<vec3> ways(const Mesh&, const Framed& framed) {
    std::vector<vec3> list;
    for (const OnFrames& v : framed.vertices)
        list.push_back(v.weights.x * v.arms[0] + v.weights.y * v.arms[1] + v.weights.z * v.arms[2]);
    return list;
}

}  // namespace

Reach reach(const Mesh& mesh, const Embedding& embedding) {
    const std::vector<vec3> list =
        std::visit([&](const auto& vertices) { return ways(mesh, vertices); }, embedding.vertices);
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
