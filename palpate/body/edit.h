#pragma once
#include "palpate/body/body.h"
#include "palpate/body/embedding.h"

#include <vector>

namespace palpate {

/// What is cut out of a body.
struct Edit {
    std::vector<uvec2> links;  // pairs of nodes: all springs between them go
    std::vector<int> cells;    // of Body::cells: they go, with their share of springs and of mass
};

/// What became of a body by an edit.
struct BodyChange {
    std::vector<int>
        node_before;  // the number that each node had; a node that nothing holds any more is gone
    std::vector<int> cell_before;  // the same of cells
    std::vector<int> nodes;        // whose springs, mass or outside are others now
    struct Gone {
        std::array<int, 8> nodes;  // as they were numbered
        ivec3 place;               // in the grid, of the first corner
    };
    std::vector<Gone> cells_gone;
    std::size_t nodes_before = 0;  // so many there were

    bool same_nodes() const { return node_before.size() == nodes_before; }
};

/// Cuts springs and cells out of a body. A spring of a grid is as strong as the cells that are left around it
/// say; a hinge goes with any edge of its two triangles along which springs are cut; a node weighs as much
/// of what it did as is left of the cells around it. Tissue is held by its cells: there a cut spring of the
/// grid changes nothing but normals, so cut cells. Nodes that were corners of cells and are no more, and that
/// no listed spring holds, go. Where cells went the outside is where their neighbours were: its cover is 0
/// there. Throws Error, and nothing has changed, where the edit names nodes or cells that there are not.
BodyChange apply(Body& body, const Edit& edit);

/// Hangs a surface again after a change of its body. A vertex whose cell is gone goes to the nearest one that
/// is left, and keeps its place at rest. False, and it is as it was, where a vertex hung on nodes that are
/// gone by other mappings than trilinear: call embed() again for those.
bool rehang(Embedding& embedding, const Body& body, const BodyChange& change);

}  // namespace palpate
