#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>

namespace palpate {

// Each step changes the mesh in place, drops its normals if positions or vertices change, and returns a count
// for the report. None of them ever makes a position that is not finite.

/// Makes one vertex of all that lie at the same place; returns how many vertices went.
/// `tolerance` (m): a vertex no farther than this from one before it becomes that one; 0 welds only equal
/// positions.
std::size_t weld(Mesh& mesh, float tolerance = 0);

/// Drops faces with two equal corners, second copies of the same face, and vertices no face uses; returns how
/// many faces went. Weld first: then what lies in one place is equal. A face whose three corners merely lie
/// in a line stays, because it holds its neighbours together: so a closed mesh stays closed.
std::size_t drop_collapsed(Mesh& mesh);

/// Drops vertices no face uses; returns how many went.
std::size_t drop_unused(Mesh& mesh);

/// Keeps the connected part with the most faces; returns how many other parts went.
std::size_t keep_largest(Mesh& mesh);

/// Taubin's smoothing: `passes` pairs of a shrinking and a growing step, so that the volume stays within a
/// percent or two. Removes the staircase that a voxel grid leaves on an isosurface.
void smooth(Mesh& mesh, int passes);

/// Simplifies to about `faces` faces by collapsing edges where it shows least (quadric error); returns how
/// many faces went. Leaves a mesh that has fewer already as it is. A closed mesh stays closed. A part that
/// hung on by a single vertex may come loose: keep_largest afterwards drops it.
std::size_t decimate(Mesh& mesh, std::size_t faces);

/// What a look at a mesh finds. A closed mesh has open_edges = 0 and bad_edges = 0.
struct Soundness {
    std::size_t parts = 0;       // connected parts
    std::size_t open_edges = 0;  // edges with one face
    std::size_t bad_edges = 0;   // edges with more than two faces, or two that run the same way
};
Soundness soundness(const Mesh& mesh);

}  // namespace palpate
