#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// About so many triangles that have a mesh's shape, or as many as it has if those are fewer. They are
/// between vertices of the mesh, so that they move along with it.
std::vector<uvec3> simplified(const Mesh& mesh, std::size_t triangles);

/// The same in an order in which neighbours follow each other, so that a vertex that several of them share is
/// shaded once.
std::vector<uvec3> thinned(const Mesh& mesh, std::size_t triangles);

}  // namespace palpate
