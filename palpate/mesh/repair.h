#pragma once
#include <cstddef>

#include "palpate/mesh/mesh.h"

namespace palpate {

// Each step changes the mesh in place, drops its normals if positions or vertices change, and returns a count for
// the report. None of them ever makes a position that is not finite.

/// Makes one vertex of all that lie at the same place; returns how many vertices went.
/// `tolerance` (m): vertices closer than this are one; 0 welds only equal positions.
std::size_t weld(Mesh& mesh, float tolerance = 0);

/// Drops faces with two equal corners or no area, second copies of the same face, and vertices no face uses;
/// returns how many faces went.
std::size_t drop_collapsed(Mesh& mesh);

/// Keeps the connected part with the most faces; returns how many other parts went.
std::size_t keep_largest(Mesh& mesh);

/// Taubin's smoothing: `passes` pairs of a shrinking and a growing step, so that the volume stays within a percent
/// or two. Removes the staircase that a voxel grid leaves on an isosurface.
void smooth(Mesh& mesh, int passes);

/// Simplifies to about `faces` faces by collapsing edges where it shows least (quadric error); returns how many faces
/// went. Leaves a mesh that has fewer already as it is. A closed mesh stays closed.
std::size_t decimate(Mesh& mesh, std::size_t faces);

/// What a look at a mesh finds. A closed mesh has open_edges = 0 and bad_edges = 0.
struct Soundness {
    std::size_t parts = 0;       // connected parts
    std::size_t open_edges = 0;  // edges with one face
    std::size_t bad_edges = 0;   // edges with more than two faces, or two that run the same way
};
Soundness soundness(const Mesh& mesh);

}  // namespace palpate
