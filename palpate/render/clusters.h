#pragma once
#include "palpate/mesh/mesh.h"

#include <vector>

namespace palpate {

/// A mesh's triangles in groups that lie together and look the same way, each with few vertices.
struct Clusters {
    std::vector<uvec3> triangles;   // the mesh's, one cluster after the other; each turns as it did
    std::vector<std::size_t> ends;  // where each cluster's end in that list
};

/// At most `vertices` (3 to 255) and `faces` (4 to 512, a multiple of 4) in each.
Clusters clusters(const Mesh& mesh, std::size_t vertices, std::size_t faces);

}  // namespace palpate
