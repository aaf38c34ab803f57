#pragma once
#include "palpate/base/names.h"
#include "palpate/body/body.h"
#include "palpate/body/nodes.h"
#include "palpate/mesh/mesh.h"

#include <array>
#include <variant>
#include <vector>

namespace palpate {

class Team;

/// How a fine surface follows the nodes (skinning). All but `trilinear` attach it to the boundary surface of
/// the body: the hull of its cells, or its faces.
enum class Mapping {
    automatic,      // trilinear if there are cells; on a sheet the one that does best in a trial; otherwise
                    // frames
    one_to_one,     // each vertex is at the nearest node, with its approximate normal (2005, section 3.2)
    constant,       // barycentric weights in a triangle of nodes, and an offset in the triangle's own basis
                    // (eq. 4 to 7)
    interpolated,   // the same, with the basis turned to the nodes' approximate normals (eq. 8)
    normal_offset,  // barycentric weights, and an offset along the interpolated normal only (section 3.5)
    trilinear,      // in a cell, by trilinear interpolation of its eight corners; normals by the deformation
                    // gradient
    frames,         // in a triangle, blending the deformation gradients at its nodes
};

inline std::span<const Named<Mapping>> names(Mapping) {
    static constexpr Named<Mapping> all[] = {{Mapping::automatic, "automatic"},
                                             {Mapping::one_to_one, "one-to-one"},
                                             {Mapping::constant, "constant"},
                                             {Mapping::interpolated, "interpolated"},
                                             {Mapping::normal_offset, "normal-offset"},
                                             {Mapping::trilinear, "trilinear"},
                                             {Mapping::frames, "frames"}};
    return all;
}

/// A vertex in a cell of the lattice.
struct InCell {
    vec3 at;                   // the place in the cell, 0 to 1 along each edge; outside of that for a vertex
                               // outside the cell
    vec3 normal;               // of the surface at rest, in the cell's own axes, unit
    std::array<int, 8> nodes;  // the cell's corners
};

/// A vertex on a triangle of nodes.
struct OnTriangle {
    vec3 weights;     // barycentric: they add up to 1, and give the reference point (eq. 4)
    vec3 offset;      // from there to the vertex, in the basis, m (eq. 7)
    vec3 normal;      // of the surface at rest, in the basis, unit
    float curvature;  // how far the basis turns to the approximate normals: 0 constant, 1 interpolated
    std::array<int, 3> nodes;
};

/// The contribution of a neighbour to a node's frame.
struct Spoke {
    int to;
    vec3 pull;  // 1/m: the outer product of the vector to the neighbour with this is its term of the gradient
};

/// The deformation gradient at a node, a least-squares fit (moving least squares) over its springs: the pulls
/// hold their rest vectors times the inverse moment matrix.
struct Frame {
    int node;
    int spokes_end, faces_end;  // the end of its ranges in the lists; they begin where those of the frame
                                // before end
    vec3 normal_pull;  // in a sheet, of the normal of the faces: its springs do not determine the direction
                       // of thickness
    mat3 rest;         // the part of the gradient that nothing determines, which stays as at rest: nearly
                       // always zero
};

/// A vertex on the frames of three nodes, by linear blend skinning: the weighted sum of node + frame · arm.
struct OnFrames {
    vec3 weights;
    std::array<vec3, 3> arms;  // m, to the vertex from half way between the node and the place under the
                               // vertex
    vec3 normal;               // of the surface at rest, unit
    std::array<int, 3> frames;
};

/// All vertices on frames, and the frames that they share.
struct Framed {
    std::vector<Frame> frames;
    std::vector<Spoke> spokes;
    std::vector<std::array<int, 3>> faces;  // around the nodes of sheets
    std::vector<OnFrames> vertices;
};

/// How each vertex of a surface follows the nodes of a body. Plain data; works with any source of node
/// positions.
struct Embedding {
    std::variant<std::vector<InCell>, std::vector<OnTriangle>, Framed> vertices;
    std::vector<vec4> tangents;  // at rest, in the same basis as the normals; empty if the mesh has none
    mat3 edges = mat3(0);        // m, of the cells at rest (cell_edges), for InCell
    std::size_t nodes = 0;       // of the body
};

/// Attaches a surface to a body at rest, whatever the body's orientation; vertex normals are computed if it
/// has none. Each vertex gets the nearest cell or triangle as seen from inside the surface, so that it does
/// not stick to the opposite wall of a narrow gap. Throws Error if the surface or the body is not sound
/// (check()), if the body has neither cells nor faces, or if trilinear is requested and it has no cells.
Embedding embed(const Mesh& surface, const Body& body, Mapping mapping = Mapping::automatic);

/// That of some vertices of the surface, in this order, without tangents: to map fewer.
Embedding part_of(const Embedding& whole, std::span<const unsigned> vertices);

/// Maps the surface: computes its positions and unit normals from the nodes' current positions and, on
/// request, its tangents: unit, perpendicular to the normals, with their handedness kept. Outputs are
/// resized; tangents are empty if the mesh had none. The nodes' approximate normals are needed by one-to-one,
/// interpolated and normal-offset only. Throws Error if there are fewer nodes than the body has. Degenerate
/// triangles and cells also give finite positions and unit normals. A team, if there is one, shares the work;
/// the result is the same to the bit.
void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals, std::vector<vec4>* tangents = nullptr, Team* team = nullptr);

/// The positions alone, the same to the bit: for collisions and measurements, which need no normals.
void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            Team* team = nullptr);

/// The approximate normal of every node (2005, eq. 3): the sum of the unit vectors from its neighbours, each
/// weighted by its link's share. Not normalised; short, and unreliable, where neighbours surround the node
/// evenly. In a sheet it is the unit normal of the fan of springs around the node.
std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions);

}  // namespace palpate
