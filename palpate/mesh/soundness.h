#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>

namespace palpate {

/// A topological check of a mesh. A part is a connected component by vertices, so weld first. A closed mesh
/// has open_edges = 0 and bad_edges = 0.
struct Soundness {
    std::size_t parts = 0;
    std::size_t open_edges = 0;       // edges with one face: the border
    std::size_t bad_edges = 0;        // crowded or clashing edges
    std::size_t crowded_edges = 0;    // non-manifold: with more than two faces
    std::size_t clashing_edges = 0;   // with two faces of inconsistent orientation, which run along it the
                                      // same way
    std::size_t shared_vertices = 0;  // non-manifold: where several sheets touch
    std::size_t unused_vertices = 0;  // in no face
    std::size_t holes = 0;            // loops of open edges
    double longest_hole = 0;          // m, its circumference
    std::size_t copied_faces = 0;     // with the same three corners as an earlier face, in either orientation
    std::size_t collapsed_faces = 0;  // with two equal corners
    std::size_t flat_faces = 0;       // degenerate: with collinear corners
    std::size_t one_sided_parts = 0;  // non-orientable, such as a Möbius band
    std::size_t inward_parts = 0;     // closed parts of negative volume: inside out, or cavities
    std::size_t specks = 0;           // parts shorter than a hundredth of the longest
    long euler = 0;  // the Euler characteristic, vertices - edges + faces: 2 - 2 · genus for
                     // each closed part

    bool closed() const { return open_edges == 0 && bad_edges == 0; }
};

/// Takes about linear time for any mesh.
Soundness soundness(const Mesh& mesh);

/// How the closed parts of a mesh are nested.
struct Nesting {
    std::size_t inside_out = 0;  // outside all others, with negative volume
    std::size_t redundant = 0;   // inside another without being a cavity: a solid needs no such wall
    std::size_t cavities = 0;    // inside another, with opposite orientation
    std::size_t crossing = 0;    // partly inside another, as tested at eight of their faces
};

/// If there are several parts, it builds a tree over all faces.
Nesting nesting(const Mesh& mesh);

}  // namespace palpate
