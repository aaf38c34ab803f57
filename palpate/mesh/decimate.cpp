#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <meshoptimizer.h>

#include <utility>
#include <vector>

namespace palpate {

std::size_t decimate(Mesh& mesh, std::size_t faces) {
    const std::size_t before = mesh.triangles.size();
    if (before <= faces) return 0;
    // The number of faces decides, so any error is allowed: 1 is as much as the whole mesh is wide.
    std::vector<uvec3> kept(before);
    const std::size_t indices =
        meshopt_simplify(&kept[0].x, &mesh.triangles[0].x, 3 * before, &mesh.positions[0].x,
                         mesh.positions.size(), sizeof(vec3), 3 * faces, 1.0f, 0, nullptr);
    kept.resize(indices / 3);
    mesh.triangles = std::move(kept);
    drop_attributes(mesh);
    // meshoptimizer collapses edges without asking whether a tunnel or a thin neck closes, so two things are
    // left where one did: a face lying on the back of another, and an edge in which two sheets touch.
    drop_flaps(mesh);
    part_sheets(mesh);
    drop_unused(mesh);
    return before - mesh.triangles.size();
}

}  // namespace palpate
