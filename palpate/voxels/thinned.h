#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// A simplified level of detail: about this many triangles, or all if there are fewer. They use the mesh's
/// vertices, so they move along with it.
std::vector<uvec3> simplified(const Mesh& mesh, std::size_t triangles);

/// The same, ordered for the GPU's vertex cache, so that shared vertices are shaded once.
std::vector<uvec3> thinned(const Mesh& mesh, std::size_t triangles);

}  // namespace palpate
