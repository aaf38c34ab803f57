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

/// How a fine surface follows the nodes. All but `trilinear` hang it on the outside of the body: the hull of
/// its cells, or its faces.
enum class Mapping {
    automatic,      // trilinear where there are cells; on a sheet what does best on trial; else frames
    one_to_one,     // on the nearest node, as it is, with its approximate normal (2005, section 3.2)
    constant,       // on a triangle of nodes, in the triangle's own basis (eq. 4 to 7)
    interpolated,   // the same, with the basis turned to the nodes' approximate normals (eq. 8)
    normal_offset,  // the same, but off the triangle along the interpolated normal only (section 3.5)
    trilinear,      // in a cell, by its eight corners and the gradient of the deformation
    frames,         // on a triangle, by a frame of each node that its neighbours stretch and turn
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
    vec3 at;                   // where in the cell, 0 to 1 along each edge; a vertex outside goes beyond
    vec3 normal;               // of the surface at rest, along the cell's own axes, unit
    std::array<int, 8> nodes;  // the cell's corners
};

/// A vertex on a triangle of nodes.
struct OnTriangle {
    vec3 weights;     // of the nodes: their sum, 1 in all, is the reference point (eq. 4)
    vec3 offset;      // from there to the vertex, in the basis, m (eq. 7)
    vec3 normal;      // of the surface at rest, in the basis, unit
    float curvature;  // how far the basis turns to the approximate normals: 0 constant, 1 interpolated
    std::array<int, 3> nodes;
};

/// What a neighbour says about a node's frame.
struct Spoke {
    int to;
    vec3 pull;  // 1/m: the neighbour's way from the node, times this, is its part of the gradient
};

/// The gradient of the deformation at a node, by least squares over its springs: their rest vectors and the
/// inverse of their moments are in the pulls.
struct Frame {
    int node;
    int spokes_end, faces_end;  // where its own end in the lists; they begin where the last frame's end
    vec3 normal_pull;  // of the faces' normal, in a sheet: its springs do not say where thickness goes
    mat3 rest;         // what stays as at rest since nothing tells: nearly always zero
};

/// A vertex on the frames of three nodes: each carries it along, from the node's place by the frame times the
/// arm, and the weights say how much.
struct OnFrames {
    vec3 weights;
    std::array<vec3, 3> arms;  // to the vertex, from half way between each node and the place under it, m
    vec3 normal;               // of the surface at rest, unit
    std::array<int, 3> frames;
};

/// All vertices on frames, and the frames that they share.
struct Framed {
    std::vector<Frame> frames;
    std::vector<Spoke> spokes;
    std::vector<std::array<int, 3>> faces;  // round the nodes of sheets
    std::vector<OnFrames> vertices;
};

/// How each vertex of a surface hangs on the nodes of a body. Plain data; works with any source of node
/// positions.
struct Embedding {
    std::variant<std::vector<InCell>, std::vector<OnTriangle>, Framed> vertices;
    std::vector<vec4> tangents;  // at rest, in the same basis as the normals; empty if the mesh has none
    mat3 edges = mat3(0);        // m, of the cells at rest (cell_edges), where it hangs in cells
    std::size_t nodes = 0;       // of the body
};

/// Hangs a surface on a body at rest, however that lies turned; normals are computed where it has none. Each
/// vertex goes to the nearest cell or triangle as seen from inside the surface, so that it does not stick to
/// the other wall of a narrow gap. Throws Error if surface or body are not sound (check()), if the body has
/// neither cells nor faces, or if trilinear is asked for and it has no cells.
Embedding embed(const Mesh& surface, const Body& body, Mapping mapping = Mapping::automatic);

/// Positions and unit normals of the surface for the nodes' current places, and if asked its tangents: unit,
/// at right angles to the normals, their handedness kept. Outputs are resized; tangents are empty if the mesh
/// had none. The nodes' approximate normals are used by one-to-one, interpolated and normal-offset; the
/// others need none. Throws Error where there are fewer nodes than the body has. Collapsed triangles and
/// cells give finite positions and unit normals all the same. A team, if there is one, shares the work; it
/// changes no bit.
void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals, std::vector<vec4>* tangents = nullptr, Team* team = nullptr);

/// The approximate normal of every node (2005, eq. 3): the sum of the unit vectors from its neighbours, each
/// by its link's share. Not normalised; short where the neighbours surround the node evenly and it means
/// little. A sheet has neighbours on no side: there it is the unit normal of the fan of springs round the
/// node.
std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions);

}  // namespace palpate
