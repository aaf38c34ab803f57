#pragma once
#include "palpate/mesh/tree.h"

#include <cstddef>
#include <vector>

namespace palpate {

struct Intersections {
    std::vector<uvec2> faces;  // pairs, each once
    bool all = true;           // whether the search came to its end
};

/// Pairs of faces that cut through each other: a side of one passes through the other, beyond what rounding
/// in double may have made. Faces that merely touch or lie in one plane do not count, nor do neighbours in
/// the edge they share. Gives up, and says so, after about `most` pairs or a hundred tests a face, which
/// only great bundles of long thin faces need.
Intersections intersections(const Mesh& mesh, std::size_t most = 1'000'000);
Intersections intersections(const Tree& tree, std::size_t most = 1'000'000);

/// How many pairs of faces a search of this kind looks at before it gives up.
std::size_t most_looks_at(const Mesh& mesh);

/// Where few faces cut through each other, removes those with a ring around them and closes the holes, a few
/// times over. Returns how many faces were removed; 0, and the mesh as it was, if that does not help.
/// The mesh must be closed.
std::size_t mend_intersections(Mesh& mesh, const Intersections& found);

}  // namespace palpate
