#pragma once
#include "palpate/mesh/arrangement.h"
#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// The connected components of a mesh: faces that are connected by vertices.
struct Parts {
    std::vector<Index> of;  // the part of each face
    Index count = 0;
};
Parts parts(const Mesh& mesh);

/// The faces of each group, such as a part.
std::vector<std::vector<Index>> faces_by(const std::vector<Index>& group_of_face, Index groups);

/// The bounding box of each part.
std::vector<Bounds> boxes(const Mesh& mesh, const Parts& parts);

/// The area of each part, m².
std::vector<double> areas(const Mesh& mesh, const Parts& parts);

/// The volume of each part, m³, relative to the centre of its own box; negative if it is inside out.
std::vector<double> volumes(const Mesh& mesh, const Parts& parts);

/// The longest side of each part's box, m.
std::vector<float> sides(const Mesh& mesh, const Parts& parts);

/// Which parts turn_parts() would flip: those outside of all others, if they are inside out; and all parts,
/// if all of those are. The mesh, to which `arrangement` must belong, is changed only temporarily.
std::vector<char> wrong_way_out(Mesh& mesh, const Parts& parts, Arrangement& arrangement);

/// Flips the faces of those parts for which `turn` is true; a second call undoes it.
void turn_over(Mesh& mesh, const Parts& parts, const std::vector<char>& turn);

/// Keeps the faces of those parts for which `keep` is true, with their vertices; returns what was dropped.
Dropped keep_parts(Mesh& mesh, const Parts& parts, const std::vector<char>& keep);

/// The number of non-orientable parts, such as a Möbius band.
std::size_t one_sided_parts(const Mesh& mesh);

}  // namespace palpate
