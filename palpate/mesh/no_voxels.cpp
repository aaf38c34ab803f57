// Takes the place of palpate/voxels/ in a build without it: each of its functions throws an Error.
#include "palpate/base/error.h"
#include "palpate/mesh/remake.h"
#include "palpate/mesh/repair.h"

namespace palpate {

Remade remake(const Mesh&, float, const std::string& name, const Progress&) {
    throw missing_part("voxels", name, "repair its walls in the program that made it");
}

std::size_t decimate(Mesh&, std::size_t) {
    throw missing_part("voxels", "decimating a mesh", "simplify it in the program that made it");
}

}  // namespace palpate
