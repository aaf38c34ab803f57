#include "palpate/body/scatter.h"

#include "palpate/base/error.h"
#include "palpate/body/embedding_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

using Text = MappingIn<double>;

// The nodes that a vertex follows.
std::vector<int> followed(const OnTriangle& vertex) { return {vertex.nodes.begin(), vertex.nodes.end()}; }
struct OnItsFrames {
    const Framed& all;
    const OnFrames& vertex;

    template <class Visit>
    void for_each_spoke(int frame, Visit visit) const {
        for (int s = frame > 0 ? all.frames[std::size_t(frame) - 1].spokes_end : 0;
             s < all.frames[std::size_t(frame)].spokes_end; ++s)
            visit(all.spokes[std::size_t(s)]);
    }
    template <class Visit>
    void for_each_face(int frame, Visit visit) const {
        for (int f = frame > 0 ? all.frames[std::size_t(frame) - 1].faces_end : 0;
             f < all.frames[std::size_t(frame)].faces_end; ++f)
            visit(all.faces[std::size_t(f)]);
    }
};
std::vector<int> followed(const OnItsFrames& on) {
    std::vector<int> nodes;
    for (int frame : on.vertex.frames) {
        nodes.push_back(on.all.frames[std::size_t(frame)].node);
        on.for_each_spoke(frame, [&](const Spoke& spoke) { nodes.push_back(spoke.to); });
        on.for_each_face(frame, [&](const std::array<int, 3>& face) {
            nodes.insert(nodes.end(), face.begin(), face.end());
        });
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

// Where a vertex is, with the nodes at(node), m.
template <class At>
dvec3 place(const InCell& vertex, At at, std::span<const vec3>) {
    dvec3 corner[8];
    for (std::size_t k = 0; k < 8; ++k) corner[k] = at(vertex.nodes[k]);
    return Text::in_cell(corner, vertex.at.x, vertex.at.y, vertex.at.z).position;
}
template <class At>
dvec3 place(const OnTriangle& vertex, At at, std::span<const vec3> normals) {
    const auto [a, b, c] = vertex.nodes;
    dvec3 approximate(0), under(0);
    for (int k = 0; k < 3; ++k) {
        const int node = vertex.nodes[std::size_t(k)];
        under += double(vertex.weights[k]) * at(node);
        if (vertex.curvature > 0)
            approximate +=
                double(vertex.weights[k]) * Text::clear_direction(dvec3(normals[std::size_t(node)]));
    }
    const Text::MappedVertex f = Text::on_triangle(at(a), at(b), at(c), approximate, vertex.curvature);
    return under + Text::expand(f, vertex.offset.x, vertex.offset.y, vertex.offset.z);
}
template <class At>
dvec3 place(const OnItsFrames& on, At at, std::span<const vec3>) {
    dvec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k) {
        const int number = on.vertex.frames[k];
        const Frame& frame = on.all.frames[std::size_t(number)];
        const dvec3 here = at(frame.node);
        dmat3 gradient(frame.rest);
        on.for_each_spoke(number, [&](const Spoke& spoke) {
            gradient += glm::outerProduct(at(spoke.to) - here, dvec3(spoke.pull));
        });
        dvec3 areas(0);
        on.for_each_face(number, [&](const std::array<int, 3>& face) {
            areas += glm::cross(at(face[1]) - at(face[0]), at(face[2]) - at(face[0]));
        });
        gradient += glm::outerProduct(Text::direction(areas, dvec3(0)), dvec3(frame.normal_pull));
        sum += double(on.vertex.weights[int(k)]) * (here + gradient * dvec3(on.vertex.arms[k]));
    }
    return sum;
}

// A node that a vertex follows, and the Jacobian of the vertex's place by the node's.
struct Share {
    int node;
    dmat3 jacobian;
};

// By central differences.
template <class Vertex>
std::vector<Share> shares_of(const Vertex& vertex, const Nodes& nodes) {
    auto now = [&](int node) { return dvec3(nodes.positions[std::size_t(node)]); };
    std::vector<Share> shares;
    double size = 0;
    const std::vector<int> all = followed(vertex);
    for (int node : all) size = std::max(size, glm::distance(now(node), now(all[0])));
    const double hair = 1e-5 * size;
    for (int node : all) {
        Share share{node, dmat3(0)};
        for (int k = 0; k < 3 && size > 0; ++k) {
            auto moved = [&](double by) {
                return place(
                    vertex,
                    [&](int i) {
                        dvec3 p = now(i);
                        if (i == node) p[k] += by;
                        return p;
                    },
                    nodes.normals);
            };
            share.jacobian[k] = (moved(hair) - moved(-hair)) / (2 * hair);
        }
        shares.push_back(share);
    }
    return shares;
}

// In a cell the place is linear in the nodes'.
std::vector<Share> shares_of(const InCell& vertex, const Nodes&) {
    std::vector<Share> shares;
    for (std::size_t k = 0; k < 8; ++k) {
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = double(vertex.at[axis]);
            weight *= (k >> axis & 1) ? at : 1 - at;
        }
        shares.push_back({vertex.nodes[k], dmat3(weight)});
    }
    return shares;
}

// Calls visit(vertex) with what carries the vertex of that number.
template <class Visit>
auto of_vertex(const Embedding& embedding, std::size_t number, Visit visit) {
    if (const auto* framed = std::get_if<Framed>(&embedding.vertices))
        return visit(OnItsFrames{*framed, framed->vertices[number]});
    if (const auto* in_cells = std::get_if<std::vector<InCell>>(&embedding.vertices))
        return visit((*in_cells)[number]);
    return visit(std::get<std::vector<OnTriangle>>(embedding.vertices)[number]);
}

}  // namespace

std::vector<NodePush> scatter(const Embedding& embedding, const Nodes& nodes,
                              std::span<const SurfacePush> pushes) {
    check(nodes, embedding);
    std::vector<NodePush> all;
    for (const SurfacePush& push : pushes) {
        if (push.vertex >= vertex_count(embedding))
            throw Error(fmt::format("a push on vertex {} of {}", push.vertex, vertex_count(embedding)),
                        "the surface that is pushed", "count vertices from 0");
        of_vertex(embedding, push.vertex, [&](const auto& vertex) {
            const std::vector<Share> shares = shares_of(vertex, nodes);
            const vec3 way =
                push.to -
                vec3(place(
                    vertex, [&](int i) { return dvec3(nodes.positions[std::size_t(i)]); }, nodes.normals));
            auto carries = [](const Share& share) {
                const dmat3& j = share.jacobian;
                return std::max(0.0, (j[0][0] + j[1][1] + j[2][2]) / 3);
            };
            double carried = 0;
            for (const Share& share : shares) carried += carries(share);
            for (const Share& share : shares)
                all.push_back(
                    {.node = share.node,
                     .to = nodes.positions[std::size_t(share.node)] + way,
                     .velocity = push.velocity,
                     .stiffness = carried > 0 ? float(carries(share) / carried) * push.stiffness : 0,
                     .force = vec3(glm::transpose(share.jacobian) * dvec3(push.force))});
        });
    }
    return all;
}

}  // namespace palpate
