#pragma once
#include "palpate/mesh/mesh.h"

#include <vector>

namespace palpate {

/// A mesh's triangles in clusters (meshlets): groups that lie close together and face nearly the same way,
/// each with few vertices.
struct Clusters {
    std::vector<uvec3> triangles;   // the mesh's, one cluster after the other, with their winding order kept
    std::vector<std::size_t> ends;  // for each cluster, the index after its last triangle
};

/// Each has at most `vertices` (3 to 255) and `faces` (4 to 512, a multiple of 4).
Clusters clusters(const Mesh& mesh, std::size_t vertices, std::size_t faces);

}  // namespace palpate
