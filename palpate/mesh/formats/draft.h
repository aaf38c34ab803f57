#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

using Index = std::uint32_t;

/// A surface as a file tells it: polygons, in the file's units, with nothing checked yet.
struct Draft {
    std::vector<dvec3> positions;
    std::vector<dvec3> normals;        // one a vertex; or empty
    std::vector<dvec2> uvs{};          // one a vertex, as a Mesh has them; or empty
    std::vector<Index> corners;        // of all faces, one face after the other
    std::vector<Index> sizes;          // how many of them each face has
    bool single = false;               // the positions were floats: what those have lost is lost
    std::vector<std::string> notes{};  // what the reader left out
};

/// Makes a mesh of it, of its faces of three corners or more. What lies so far from the origin that floats
/// would lose its shape is moved there, and a note says so. Throws Error, with `name` for the file, if there
/// are no faces, if one names a vertex that does not exist, if a position is no finite float, or if the shape
/// is lost already.
Mesh finish(const Draft& draft, Units units, const std::string& name, std::vector<std::string>* notes);

}  // namespace palpate
