#pragma once
#include "palpate/mesh/tree.h"

#include <cstddef>
#include <vector>

namespace palpate {

struct Intersections {
    std::vector<uvec2> faces;  // pairs, each once
    bool all = true;           // whether the search was completed
};

/// Self-intersections: pairs of faces that cut through each other, where a side of one passes through the
/// other by more than rounding in double can explain. Faces that only touch or are coplanar do not count, nor
/// does the shared edge of neighbours. Gives up, with all = false, after about `most` pairs or a hundred
/// tests a face, which only large bundles of long thin faces need.
Intersections intersections(const Mesh& mesh, std::size_t most = 1'000'000);
Intersections intersections(const Tree& tree, std::size_t most = 1'000'000);

/// How many pairs of faces such a search tests before it gives up.
std::size_t most_tests_of(const Mesh& mesh);

/// If few faces cut through each other, removes them with a ring of faces around them and closes the holes,
/// repeatedly. Returns how many faces were removed; 0, with the mesh unchanged, if that does not help. The
/// mesh must be closed.
std::size_t mend_intersections(Mesh& mesh, const Intersections& found);

}  // namespace palpate
