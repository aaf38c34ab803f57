#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

float distance_to_cell(vec3 point, vec3 corner, float spacing) {
    return glm::length(glm::max(glm::max(corner - point, point - corner - spacing), vec3(0)));
}

}  // namespace

std::vector<InCell> embed_in_cells(const Mesh& surface, const Body& body) {
    std::vector<Bounds> boxes(body.cells.size());
    for (std::size_t c = 0; c < boxes.size(); ++c) {
        boxes[c].include(body.positions[body.cells[c][0]]);
        boxes[c].include(body.positions[body.cells[c][7]]);
    }
    const Nearby cells(boxes);
    std::vector<InCell> vertices;
    vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i], n = surface.normals[i];
        // The nearest cell to the vertex; of cells about as near, the one nearest to a point half a cell
        // inside, so that the far wall of a gap is not taken for the near one.
        const vec3 inside = v - 0.5f * body.spacing * n;
        const auto& nodes = body.cells[cells.best(v, [&](int c, float) {
            const vec3 corner = body.positions[body.cells[c][0]];
            return distance_to_cell(v, corner, body.spacing) +
                   0.25f * distance_to_cell(inside, corner, body.spacing);
        })];
        vertices.push_back({(v - body.positions[nodes[0]]) / body.spacing, n, nodes});
    }
    return vertices;
}

}  // namespace palpate
