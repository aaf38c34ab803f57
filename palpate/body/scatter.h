#pragma once
#include "palpate/body/embedding.h"
#include "palpate/body/influences.h"

#include <span>
#include <vector>

namespace palpate {

/// What somebody does to one vertex of a surface: as a NodePush does to a node.
struct SurfacePush {
    std::size_t vertex = 0;
    vec3 to = vec3(0);        // m, at the start of the call: where the spring draws it
    vec3 velocity = vec3(0);  // m/s, of that point
    float stiffness = 0;      // N/m, of the spring
    vec3 force = vec3(0);     // N
};

/// What pushes on a surface do to the nodes that it hangs on: the transpose of deform(). A force on a vertex
/// becomes forces on nodes, the transposed Jacobian of the vertex's place by theirs times the force: they
/// have the same sum, the same moment and do the same work. A spring becomes springs on the nodes by how far
/// each carries the vertex; together they are as stiff, and now draw as the spring does. `nodes`: where they
/// are now; approximate normals are taken as they are. Throws Error where there are fewer nodes than the body
/// has, or no approximate normals for a mapping that needs them, or a push names a vertex that there is not.
std::vector<NodePush> scatter(const Embedding& embedding, const Nodes& nodes,
                              std::span<const SurfacePush> pushes);

}  // namespace palpate
