#pragma once
#include "palpate/mesh/parts.h"

#include <vector>

namespace palpate {

/// Parts that touch, overlap or lie in each other, as one: what a solid made of them would hold together. A
/// cavity belongs to the part that it is in; what lies loose in a cavity is a piece of its own.
struct Pieces {
    std::vector<Index> of;       // each part's piece
    std::vector<double> volume;  // of each piece, m³: what its parts share counts once
    bool all = true;             // whether all that may touch was looked at
};

/// Parts may be open; they touch where they come within 1e-5 of the mesh's longest side. Parts should be the
/// right way out. A piece of several parts, or of an open one, is measured by counting points, to about two
/// hundredths; each of hundreds of them less exactly. If faces are too crowded to look at all of them,
/// everything is one piece.
Pieces pieces(const Mesh& mesh, const Parts& parts);
Pieces pieces(const Tree& tree, const Parts& parts);  // of its mesh

}  // namespace palpate
