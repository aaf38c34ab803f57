#pragma once
#include "palpate/body/embedding.h"

namespace palpate {

/// How far a surface at rest reaches beyond the nodes that it follows. It gives an estimate of the surface's
/// bounding box where the GPU maps it: the host then knows the box of the nodes, but no vertex.
struct Reach {
    float growth = 1;  // the width of the surface over the width of its anchors, the places under its
                       // vertices
    float beyond = 0;  // m, the greatest distance from an anchor to its vertex

    /// The bounding box of the surface, estimated from that of its nodes.
    Bounds around(const Bounds& nodes) const;
};

/// `mesh`: the one that was embedded.
Reach reach(const Mesh& mesh, const Embedding& embedding);

}  // namespace palpate
