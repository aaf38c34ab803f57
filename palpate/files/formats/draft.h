#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate {

using Index = std::uint32_t;

/// A surface as a file tells it: polygons, in the file's units, with nothing checked yet.
struct Draft {
    double unit = 0;  // m, the length that the file states its numbers to be in; 0: it does not
    std::vector<dvec3> positions;
    std::vector<dvec3> normals;        // one a vertex; or empty
    std::vector<dvec2> uvs{};          // one a vertex, as a Mesh has them; or empty
    std::vector<Index> corners;        // of all faces, one face after the other
    std::vector<Index> sizes;          // how many of them each face has
    std::size_t loose = 0;             // points and lines that are already left out
    bool single = false;               // the positions were floats: what those have lost is lost
    std::vector<std::string> notes{};  // what the reader left out
};

/// Whether floats at these places would lose the shape.
bool too_far_for_floats(std::span<const dvec3> positions);

/// Makes a mesh of it, of its faces of three corners or more, in metres: by `units`; where those are not
/// given, by the unit that the file states, or as it stands. If both are there and differ, a note says so.
/// What lies so far from the origin that floats would lose its shape is moved there, and a note says so.
/// Throws Error, with `name` for the file, if there are no faces, if one names a vertex that does not exist,
/// if a position is no finite float, or if the shape is lost already.
Mesh finish(const Draft& draft, std::optional<Units> units, const std::string& name,
            std::vector<std::string>* notes);

}  // namespace palpate
