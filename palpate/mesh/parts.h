#pragma once
#include "palpate/mesh/arrangement.h"
#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// What hangs together by vertices.
struct Parts {
    std::vector<Index> of;  // each face's part
    Index count = 0;
};
Parts parts(const Mesh& mesh);

/// Each part's box.
std::vector<Bounds> boxes(const Mesh& mesh, const Parts& parts);

/// Each part's area, m².
std::vector<double> areas(const Mesh& mesh, const Parts& parts);

/// Each part's volume, m³, about the middle of its own box; negative if it is inside out.
std::vector<double> volumes(const Mesh& mesh, const Parts& parts);

/// The longest side of each part's box, m.
std::vector<float> sides(const Mesh& mesh, const Parts& parts);

/// Which parts turn_parts() would turn over: those that lie in no other, if they are inside out; and all, if
/// all of these are. The mesh, of which `lie` must tell, changes only while it is asked.
std::vector<char> wrong_way_out(Mesh& mesh, const Parts& parts, Arrangement& lie);

/// Turns the faces of those parts for which `turn` is true; a second time turns them back.
void turn_over(Mesh& mesh, const Parts& parts, const std::vector<char>& turn);

/// Keeps the faces of those parts for which `keep` is true, and their vertices; returns what went.
Dropped keep_parts(Mesh& mesh, const Parts& parts, const std::vector<char>& keep);

/// Sheets in which a walk over edges with two faces comes back upside down.
std::size_t one_sided_parts(const Mesh& mesh);

}  // namespace palpate
