#pragma once
#include "palpate/body/embedding.h"

namespace palpate {

/// How a surface at rest lies about the nodes that it hangs on. As it deforms, nobody on the host knows where
/// it is, but of the nodes that is known.
struct Reach {
    float growth = 1;  // how many times as wide the surface is as the places under its vertices
    float beyond = 0;  // m, the longest way from such a place to its vertex

    /// A box around the surface, from the box around its nodes.
    Bounds around(const Bounds& nodes) const;
};

/// `mesh` is the one that was embedded.
Reach reach(const Mesh& mesh, const Embedding& embedding);

}  // namespace palpate
