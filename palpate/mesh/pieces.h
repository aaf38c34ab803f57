#pragma once
#include "palpate/mesh/parts.h"

#include <vector>

namespace palpate {

/// Groups of parts that touch, overlap or lie inside each other: what a solid made of them would hold
/// together. A cavity belongs to the part that it is in; something loose in a cavity is a piece of its own.
struct Pieces {
    std::vector<Index> of;       // the piece of each part
    std::vector<double> volume;  // of each piece, m³: overlaps of its parts count once
    bool all = true;             // whether the search for touching parts was completed
};

/// Parts may be open, and should face outwards. They touch where their distance is below 1e-5 of the mesh's
/// longest side. The volume of a piece of several parts, or of an open one, is estimated by counting sample
/// points, to about 2 %; less exactly if there are hundreds of pieces. If faces are too crowded to test all
/// of them, everything is one piece.
Pieces pieces(const Mesh& mesh, const Parts& parts);
Pieces pieces(const Tree& tree, const Parts& parts);  // of its mesh

}  // namespace palpate
