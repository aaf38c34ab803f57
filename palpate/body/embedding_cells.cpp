#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

using MappedVertex = MappingText::MappedVertex;

// A vertex at `at` in a cell at rest, and the Jacobian there: the derivatives of its position by `at`, m. In
// double, so that cells may have any size that a float can hold.
MappedVertex follow_at_rest(const Body& body, const std::array<int, 8>& nodes, vec3 at) {
    vec3 corners[8];
    for (std::size_t k = 0; k < 8; ++k) corners[k] = body.positions[std::size_t(nodes[k])];
    return MappingText::in_cell(corners, at.x, at.y, at.z);
}
dmat3 gradient(const MappedVertex& f) { return {dvec3(f.x), dvec3(f.y), dvec3(f.z)}; }

// The coordinates of a place in a cell: inverts the trilinear map by Newton's method from the cell's centre.
// One step suffices for a parallelepiped, as all cells of a grid are, in any orientation.
vec3 place_in(const Body& body, const std::array<int, 8>& nodes, vec3 place) {
    vec3 at(0.5f);
    for (int step = 0; step < 4; ++step) {
        const MappedVertex there = follow_at_rest(body, nodes, at);
        if (glm::determinant(gradient(there)) == 0) break;
        at += vec3(glm::inverse(gradient(there)) * (dvec3(place) - dvec3(there.position)));
    }
    return at;
}

// A normal and a tangent in the axes of a cell, such that deform() reproduces them at rest: it transforms
// normals by the cofactors of the Jacobian, tangents by the Jacobian itself.
vec3 normal_in(const dmat3& gradient, vec3 n) {
    const double side = glm::determinant(gradient) < 0 ? -1 : 1;  // -1 for a mirrored cell
    const dvec3 in_cell = side * (glm::transpose(gradient) * dvec3(n));
    return glm::length(in_cell) > 0 ? vec3(glm::normalize(in_cell)) : n;
}
vec3 tangent_in(const dmat3& gradient, vec3 t) {
    if (glm::determinant(gradient) == 0) return t;
    const dvec3 in_cell = glm::inverse(gradient) * dvec3(t);
    return glm::length(in_cell) > 0 ? vec3(glm::normalize(in_cell)) : t;
}

// Finds the nearest cell to a vertex; among cells about as near, the one nearest to a point half a cell
// inside the surface, so that the opposite wall of a gap is not chosen.
class NearestCell {
 public:
    explicit NearestCell(const Body& body)
        : body_(body),
          edges_(cell_edges(body)),
          inverse_(glm::inverse(dmat3(edges_))),
          box_grid_(boxes(body)) {}

    const std::array<int, 8>& operator()(vec3 v, vec3 n) const {
        const vec3 inside = v - 0.5f * body_.spacing * n;
        const int best =
            box_grid_.best(v, [&](int c, float) { return distance(v, c) + 0.25f * distance(inside, c); });
        return body_.cells[std::size_t(best)];
    }

 private:
    static std::vector<Bounds> boxes(const Body& body) {
        std::vector<Bounds> boxes(body.cells.size());
        for (std::size_t c = 0; c < boxes.size(); ++c)
            for (int node : body.cells[c]) boxes[c].include(body.positions[std::size_t(node)]);
        return boxes;
    }
    float distance(vec3 point, int cell) const {
        const int first = body_.cells[std::size_t(cell)][0];
        const vec3 at = inverse_ * (point - body_.positions[std::size_t(first)]);
        return glm::length(edges_ * glm::max(glm::max(-at, at - 1.0f), vec3(0)));
    }

    const Body& body_;
    const mat3 edges_, inverse_;
    const BoxGrid box_grid_;
};

}  // namespace

std::vector<InCell> embed_in_cells(const Mesh& surface, const Body& body) {
    const NearestCell nearest(body);
    std::vector<InCell> vertices;
    vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i], n = surface.normals[i];
        const auto& nodes = nearest(v, n);
        const vec3 at = place_in(body, nodes, v);
        vertices.push_back({at, normal_in(gradient(follow_at_rest(body, nodes, at)), n), nodes});
    }
    return vertices;
}

std::vector<vec4> tangents_in(std::span<const InCell> vertices, const Body& body,
                              const std::vector<vec4>& tangents) {
    if (tangents.empty()) return {};
    std::vector<vec4> in_cells;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto& [at, normal, nodes] = vertices[i];
        in_cells.emplace_back(tangent_in(gradient(follow_at_rest(body, nodes, at)), vec3(tangents[i])),
                              tangents[i].w);
    }
    return in_cells;
}

}  // namespace palpate
