#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"
#include "palpate/voxels/thinned.h"

namespace palpate {

std::size_t decimate(Mesh& mesh, std::size_t faces) {
    const std::size_t before = mesh.triangles.size();
    if (before <= faces) return 0;
    mesh.triangles = simplified(mesh, faces);
    drop_attributes(mesh);
    // meshoptimizer collapses edges even where that closes a tunnel or a thin neck, which leaves faces back
    // to back, and edges where two sheets touch.
    drop_flaps(mesh);
    separate_sheets(mesh);
    drop_unused(mesh);
    return before - mesh.triangles.size();
}

}  // namespace palpate
