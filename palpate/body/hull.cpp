#include "palpate/body/hull.h"

#include "palpate/body/grid.h"

#include <map>
#include <tuple>

namespace palpate {
namespace {

// Each face of a cell: where it looks, and its corners in turn, counter-clockwise from outside.
constexpr struct {
    ivec3 out;
    int corners[4];
} faces[6] = {{{-1, 0, 0}, {0, 4, 6, 2}}, {{1, 0, 0}, {1, 3, 7, 5}},  {{0, -1, 0}, {0, 1, 5, 4}},
              {{0, 1, 0}, {2, 6, 7, 3}},  {{0, 0, -1}, {0, 2, 3, 1}}, {{0, 0, 1}, {4, 5, 7, 6}}};

}  // namespace

std::vector<HullTriangle> hull(const Body& body) {
    const std::vector<ivec3> places = cell_places(body);
    const GridIndex cells(places);
    std::vector<HullTriangle> triangles;
    for (std::size_t c = 0; c < places.size(); ++c)
        for (const auto& [out, corners] : faces) {
            if (cells.at(places[c] + out) >= 0) continue;
            const auto& nodes = body.cells[c];
            const vec3 normal(out);
            triangles.push_back({{nodes[corners[0]], nodes[corners[1]], nodes[corners[2]]}, int(c), normal});
            triangles.push_back({{nodes[corners[0]], nodes[corners[2]], nodes[corners[3]]}, int(c), normal});
        }
    return triangles;
}

Mesh hull_mesh(const Body& body) {
    Mesh mesh;
    std::map<std::tuple<int, float, float, float>, unsigned> vertex_of;
    auto vertex = [&](int node, vec3 normal) {
        const auto [found, fresh] =
            vertex_of.try_emplace({node, normal.x, normal.y, normal.z}, unsigned(mesh.positions.size()));
        if (fresh) {
            mesh.positions.push_back(body.positions[node]);
            mesh.normals.push_back(normal);
        }
        return found->second;
    };
    for (const HullTriangle& t : hull(body))
        mesh.triangles.push_back(
            {vertex(t.nodes[0], t.normal), vertex(t.nodes[1], t.normal), vertex(t.nodes[2], t.normal)});
    return mesh;
}

}  // namespace palpate
