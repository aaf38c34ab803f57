// In the place of palpate/voxels/ in a build without it: what of it is asked for is an Error.
#include "palpate/base/error.h"
#include "palpate/mesh/remake.h"
#include "palpate/mesh/repair.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_voxels(const std::string& where, const std::string& instead) {
    throw Error("this build of Palpate is without its part voxels", where,
                instead + ", or build with -D PALPATE_PARTS=all");
}

}  // namespace

Remade remake(const Mesh&, float, const std::string& name, const Progress&) {
    refuse_voxels(name, "mend its walls where it was made");
}

std::size_t decimate(Mesh&, std::size_t) {
    refuse_voxels("simplifying a mesh", "simplify it where it was made");
}

}  // namespace palpate
