#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

// Weight of corner k of a cell at the place `at`, and its gradient with respect to the place.
float weight(int k, vec3 at) {
    return (k & 1 ? at.x : 1 - at.x) * (k & 2 ? at.y : 1 - at.y) * (k & 4 ? at.z : 1 - at.z);
}

vec3 gradient(int k, vec3 at) {
    const vec3 side(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    const vec3 w(k & 1 ? at.x : 1 - at.x, k & 2 ? at.y : 1 - at.y, k & 4 ? at.z : 1 - at.z);
    return {side.x * w.y * w.z, side.y * w.x * w.z, side.z * w.x * w.y};
}

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
        vertices.push_back({nodes, (v - body.positions[nodes[0]]) / body.spacing, n});
    }
    return vertices;
}

void deform(const std::vector<InCell>& vertices, const Nodes& nodes, const Carried& out) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const InCell& vertex = vertices[i];
        vec3 sum(0), dx(0), dy(0), dz(0);  // the position, and the columns of the deformation's gradient
        for (int k = 0; k < 8; ++k) {
            const vec3 node = nodes.positions[vertex.nodes[k]];
            const vec3 slope = gradient(k, vertex.at);
            sum += weight(k, vertex.at) * node;
            dx += slope.x * node;
            dy += slope.y * node;
            dz += slope.z * node;
        }
        out.positions[i] = sum;
        // A normal moves with the inverse transpose of the gradient: its cofactors, which need no division.
        // A tangent moves with the gradient itself.
        const vec3 n = vertex.normal;
        out.normals[i] =
            direction(n.x * glm::cross(dy, dz) + n.y * glm::cross(dz, dx) + n.z * glm::cross(dx, dy), n);
        if (!out.tangents) continue;
        const vec4 t = out.rest_tangents[i];
        out.tangents[i] = upright(t.x * dx + t.y * dy + t.z * dz, out.normals[i], t.w);
    }
}

}  // namespace palpate
