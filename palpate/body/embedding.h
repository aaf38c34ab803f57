#pragma once
#include "palpate/base/names.h"
#include "palpate/body/body.h"
#include "palpate/body/nodes.h"
#include "palpate/mesh/mesh.h"

#include <array>
#include <variant>
#include <vector>

namespace palpate {

/// How a fine surface follows the nodes.
enum class Mapping {
    automatic,     // the best that the body allows: trilinear in a lattice
    trilinear,     // in a cell, by its eight corners; normals by the gradient of the deformation
    constant,      // on a triangle of nodes, in the triangle's own basis (2005, eq. 4 to 7)
    interpolated,  // the same, with the basis turned to the nodes' approximate normals (2005, eq. 8)
};

inline std::span<const Named<Mapping>> names(Mapping) {
    static constexpr Named<Mapping> all[] = {{Mapping::automatic, "automatic"},
                                             {Mapping::trilinear, "trilinear"},
                                             {Mapping::constant, "constant"},
                                             {Mapping::interpolated, "interpolated"}};
    return all;
}

/// A vertex in a cell of the lattice.
struct InCell {
    std::array<int, 8> nodes;  // the cell's corners
    vec3 at;                   // where in the cell, 0 to 1 along each axis; a vertex outside goes beyond
    vec3 normal;               // of the surface at rest, unit
};

/// A vertex on a triangle of nodes.
struct OnTriangle {
    std::array<int, 3> nodes;
    vec3 weights;     // of the nodes: their sum, 1 in all, is the reference point (eq. 4)
    vec3 offset;      // from there to the vertex, in the basis, m (eq. 7)
    vec3 normal;      // of the surface at rest, in the basis, unit
    float curvature;  // how far the basis turns to the approximate normals: 0 constant, 1 interpolated
};

/// How each vertex of a surface hangs on the nodes of a body. Plain data; works with any source of node
/// positions.
struct Embedding {
    std::variant<std::vector<InCell>, std::vector<OnTriangle>> vertices;
};

/// Hangs a surface, with normals, on a body at rest. Each vertex goes to the nearest cell or hull triangle as
/// seen from inside the surface, so that it does not stick to the other wall of a narrow gap. Throws Error if
/// the body has no cells to hang the surface in.
Embedding embed(const Mesh& surface, const Body& body, Mapping mapping = Mapping::automatic);

/// Positions and unit normals of the surface for the nodes' current places. Both outputs are resized.
/// Collapsed triangles and cells give finite positions and unit normals all the same.
void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals);

/// The approximate normal of every node (2005, eq. 3): the sum of the unit vectors from its neighbours, each
/// by its link's share. Not normalised; short where the neighbours surround the node evenly and it means
/// little.
std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions);

}  // namespace palpate
