#include "palpate/voxels/thinned.h"

#include <meshoptimizer.h>

namespace palpate {

std::vector<uvec3> simplified(const Mesh& mesh, std::size_t triangles) {
    const std::size_t before = mesh.triangles.size();
    if (before <= triangles) return mesh.triangles;
    // The number of triangles is the only criterion, so any error is allowed: 1 is the width of the whole
    // mesh.
    std::vector<uvec3> kept(before);
    const std::size_t corners =
        meshopt_simplify(&kept[0].x, &mesh.triangles[0].x, 3 * before, &mesh.positions[0].x,
                         mesh.positions.size(), sizeof(vec3), 3 * triangles, 1.0f, 0, nullptr);
    kept.resize(corners / 3);
    return kept;
}

std::vector<uvec3> thinned(const Mesh& mesh, std::size_t triangles) {
    std::vector<uvec3> kept = simplified(mesh, triangles);
    if (!kept.empty() && kept.size() < mesh.triangles.size())
        meshopt_optimizeVertexCache(&kept[0].x, &kept[0].x, 3 * kept.size(), mesh.positions.size());
    return kept;
}

}  // namespace palpate
