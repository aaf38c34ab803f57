#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>

namespace palpate {

/// What a look at a mesh finds. A part is what hangs together by vertices, so weld first what should. A
/// closed mesh has open_edges = 0 and bad_edges = 0.
struct Soundness {
    std::size_t parts = 0;
    std::size_t open_edges = 0;       // with one face
    std::size_t bad_edges = 0;        // crowded or clashing
    std::size_t crowded_edges = 0;    // with more than two faces
    std::size_t clashing_edges = 0;   // with two faces that run along it the same way
    std::size_t shared_vertices = 0;  // in which several sheets touch
    std::size_t unused_vertices = 0;  // of no face
    std::size_t holes = 0;            // loops of open edges
    double longest_hole = 0;          // m, around it
    std::size_t copied_faces = 0;     // with the same three corners as one before, whichever way they turn
    std::size_t collapsed_faces = 0;  // with two equal corners
    std::size_t flat_faces = 0;       // three corners in a line
    std::size_t one_sided_parts = 0;  // such as a Möbius band: no turning of faces makes all neighbours agree
    std::size_t inward_parts = 0;     // closed ones of negative volume: inside out, or cavities
    std::size_t specks = 0;           // parts shorter than a hundredth of the longest
    long euler = 0;                   // vertices - edges + faces; of closed parts 2 - 2 · handles each

    bool closed() const { return open_edges == 0 && bad_edges == 0; }
};

/// In time about linear in the mesh, whatever it is.
Soundness soundness(const Mesh& mesh);

/// How the closed parts of a mesh lie in each other.
struct Nesting {
    std::size_t inside_out = 0;  // inside no other, and of negative volume
    std::size_t redundant = 0;   // inside another and no cavity: a solid needs no such wall
    std::size_t cavities = 0;    // inside another and turning the other way
    std::size_t crossing = 0;    // partly inside another, as seen from eight of their faces
};

/// Costs a tree over all faces, if there are several parts.
Nesting nesting(const Mesh& mesh);

}  // namespace palpate
