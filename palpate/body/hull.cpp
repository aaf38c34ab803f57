#include "palpate/body/hull.h"

#include "palpate/body/grid.h"

#include <array>
#include <map>
#include <tuple>
#include <utility>

namespace palpate {
namespace {

// Each face of a cell: its direction, and its corners, counter-clockwise from outside.
constexpr struct {
    ivec3 out;
    int corners[4];
} faces[6] = {{{-1, 0, 0}, {0, 4, 6, 2}}, {{1, 0, 0}, {1, 3, 7, 5}},  {{0, -1, 0}, {0, 1, 5, 4}},
              {{0, 1, 0}, {2, 6, 7, 3}},  {{0, 0, -1}, {0, 2, 3, 1}}, {{0, 0, 1}, {4, 5, 7, 6}}};

// Their normals if the grid's axes lie along these edges.
std::array<vec3, 6> normals_of_faces(const dmat3& edges) {
    const dmat3 cofactors(glm::cross(edges[1], edges[2]), glm::cross(edges[2], edges[0]),
                          glm::cross(edges[0], edges[1]));
    const double side = glm::determinant(edges) < 0 ? -1 : 1;  // the cofactors of a mirrored grid point
                                                               // inwards
    std::array<vec3, 6> normals;
    for (std::size_t f = 0; f < 6; ++f) {
        const dvec3 out = side * (cofactors * dvec3(faces[f].out));
        normals[f] = glm::length(out) > 0 ? vec3(glm::normalize(out)) : vec3(faces[f].out);
    }
    return normals;
}

}  // namespace

std::vector<HullTriangle> hull(const Body& body) {
    const std::vector<ivec3> places = cell_places(body);
    const GridIndex cells(places);
    const dmat3 edges(cell_edges(body));
    const std::array<vec3, 6> normals = normals_of_faces(edges);
    const bool mirrored = glm::determinant(edges) < 0;
    std::vector<HullTriangle> triangles;
    for (std::size_t c = 0; c < places.size(); ++c)
        for (std::size_t f = 0; f < 6; ++f) {
            if (cells.at(places[c] + faces[f].out) >= 0) continue;
            std::array<int, 4> round;
            for (std::size_t k = 0; k < 4; ++k) round[k] = body.cells[c][std::size_t(faces[f].corners[k])];
            if (mirrored) std::swap(round[1], round[3]);
            triangles.push_back({{round[0], round[1], round[2]}, int(c), normals[f]});
            triangles.push_back({{round[0], round[2], round[3]}, int(c), normals[f]});
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

void spread_area(Body& body) {
    body.area.assign(body.count(), body.cells.empty() ? body.spacing * body.spacing : 0);
    for (const HullTriangle& triangle : hull(body))
        for (int node : triangle.nodes) body.area[node] += body.spacing * body.spacing / 6;
}

}  // namespace palpate
