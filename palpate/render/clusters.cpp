#include "palpate/render/clusters.h"

#include <meshoptimizer.h>

namespace palpate {
namespace {

constexpr float facing = 0.5f;  // how much it counts that triangles face the same way, 0 to 1

}  // namespace

Clusters clusters(const Mesh& mesh, std::size_t vertices, std::size_t faces) {
    Clusters made;
    if (mesh.triangles.empty()) return made;
    const std::size_t corners = 3 * mesh.triangles.size();
    const std::size_t most = meshopt_buildMeshletsBound(corners, vertices, faces);
    std::vector<meshopt_Meshlet> groups(most);
    std::vector<unsigned> members(most * vertices);
    std::vector<unsigned char> local(most * faces * 3);
    groups.resize(meshopt_buildMeshlets(groups.data(), members.data(), local.data(), &mesh.triangles[0].x,
                                        corners, &mesh.positions[0].x, mesh.positions.size(), sizeof(vec3),
                                        vertices, faces, facing));
    for (const meshopt_Meshlet& group : groups) {
        for (unsigned t = 0; t < group.triangle_count; ++t) {
            const unsigned char* corner = &local[group.triangle_offset + 3 * t];
            const unsigned* member = &members[group.vertex_offset];
            made.triangles.emplace_back(member[corner[0]], member[corner[1]], member[corner[2]]);
        }
        made.ends.push_back(made.triangles.size());
    }
    return made;
}

}  // namespace palpate
