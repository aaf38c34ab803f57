#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate {

using Index = std::uint32_t;

/// A surface as it is in a file: polygons, in the file's units, unchecked.
struct Draft {
    double unit = 0;  // m, the unit of length that the file states; 0: none
    std::vector<dvec3> positions;
    std::vector<dvec3> normals;        // one for each vertex; or empty
    std::vector<dvec2> uvs{};          // one for each vertex, as in a Mesh; or empty
    std::vector<Index> corners;        // of all faces, one face after the other
    std::vector<Index> sizes;          // the number of corners of each face
    std::size_t loose = 0;             // how many points and lines were skipped
    bool single = false;               // the positions were floats, with the precision of floats
    std::vector<std::string> notes{};  // what the reader skipped
};

/// Whether the precision of floats is too low for these positions.
bool too_far_for_floats(std::span<const dvec3> positions);

/// Makes a mesh, in metres, of the faces with three corners or more: by `units`; if those are not given, by
/// the unit that the file states, or else unscaled. If both are given and differ, a note says so. A mesh so
/// far from the origin that floats would lose its shape is moved to the origin, and a note says so. Throws
/// Error, with `name` for the file, if there are no faces, if one has the index of a missing vertex, if a
/// position is not a finite float, or if the shape is already lost.
Mesh finish(const Draft& draft, std::optional<Units> units, const std::string& name,
            std::vector<std::string>* notes);

}  // namespace palpate
