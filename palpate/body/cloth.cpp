#include "palpate/body/cloth.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"
#include "palpate/body/stencils.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace palpate {
namespace {

// A sheet's mass, by each node's part of its area.
void weigh(Body& body, const ClothSettings& settings) {
    if ((settings.density > 0) == (settings.mass > 0))
        throw Error("both a density and a mass above zero, or none", "the cloth", "give it one of them");
    double whole = 0;
    for (float a : body.area) whole += a;
    const double density = settings.density > 0 ? settings.density : settings.mass / whole;
    for (float a : body.area) body.inverse_mass.push_back(float(1 / (density * a)));
    body.damping = settings.damping;
    body.link_damping = settings.link_damping;
    body.cover.assign(body.count(), 0);
}

float mean_rest(std::span<const Spring> springs) {
    double sum = 0;
    for (const Spring& spring : springs) sum += spring.rest;
    return springs.empty() ? 0 : float(sum / double(springs.size()));
}

// The neighbours of a vertex in turn, counter-clockwise; closed if its triangles go all the way round.
struct Ring {
    std::vector<int> nodes;
    bool closed = false;
};

// For each node and each neighbour that an edge of a triangle leads to, the third of its nodes: it lies to
// the left of that edge, and is the next neighbour round the node.
using Thirds = std::vector<std::map<int, int>>;

Thirds thirds_of(const Body& sheet) {
    Thirds thirds(sheet.count());
    for (const auto& face : sheet.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const int from = face[k], to = face[(k + 1) % 3], third = face[(k + 2) % 3];
            if (!thirds[std::size_t(from)].emplace(to, third).second)
                throw Error(
                    fmt::format("three faces or more meet at the edge from vertex {} to {}", from, to),
                    "the cloth", "drop double faces, and turn all faces the same way");
        }
    return thirds;
}

// Calls act(from, to, left, right) for each directed edge that has a triangle on either side.
template <class Act>
void for_each_fold(const Thirds& thirds, Act act) {
    for (int from = 0; from < int(thirds.size()); ++from)
        for (const auto& [to, left] : thirds[std::size_t(from)])
            if (const auto other = thirds[std::size_t(to)].find(from); other != thirds[std::size_t(to)].end())
                act(from, to, left, other->second);
}

// `next`: for each neighbour the one that follows it in a triangle of the vertex.
Ring ring_of(std::size_t vertex, const std::map<int, int>& next) {
    const Error mixed(fmt::format("vertex {} does not lie on one sheet", vertex), "the cloth",
                      "weld the mesh, drop vertices without a face, and take parts that touch apart");
    if (next.empty()) throw mixed;
    int first = next.begin()->first;
    std::map<int, int> before;
    for (const auto& [a, b] : next)
        if (!before.emplace(b, a).second) throw mixed;
    for (std::size_t i = 0; i < next.size() && before.contains(first); ++i) first = before[first];
    Ring ring;
    int at = first;
    ring.nodes.push_back(at);
    while (next.contains(at) && ring.nodes.size() <= next.size()) {
        at = next.at(at);
        if (at == first) {
            ring.closed = true;
            break;
        }
        ring.nodes.push_back(at);
    }
    if (ring.nodes.size() != next.size() + !ring.closed) throw mixed;  // some triangles are on another fan
    return ring;
}

std::vector<Ring> rings_of(const Thirds& thirds) {
    std::vector<Ring> rings;
    for (std::size_t v = 0; v < thirds.size(); ++v) rings.push_back(ring_of(v, thirds[v]));
    return rings;
}

// m: across the triangle to the left of an edge, from the edge to its third node.
dvec3 height(dvec3 from, dvec3 to, dvec3 left) {
    const dvec3 along = glm::normalize(to - from);
    return left - from - glm::dot(left - from, along) * along;
}

// The angle through which a hinge is folded up towards the outside of its triangles, by their heights.
double fold_angle(dvec3 edge, dvec3 left, dvec3 right) {
    const double sine = glm::dot(glm::cross(left, right), glm::normalize(edge)),
                 cosine = -glm::dot(left, right);
    return std::atan2(sine, cosine);
}

}  // namespace

Body cloth(ivec2 dims, float spacing, const ClothSettings& settings) {
    if (std::min(dims.x, dims.y) < 1 || double(dims.x) * dims.y > 3e7)
        throw Error(fmt::format("{} x {} nodes", dims.x, dims.y), "the cloth",
                    "use fewer than 30 million, and 1 or more along each side");
    if (!(spacing > 0 && std::isfinite(spacing)))
        throw Error(fmt::format("a spacing of {} m", spacing), "the cloth", "use one above zero");
    if (settings.bending > 0)
        throw Error("bending of a rectangle, which bends by its flexion springs", "the cloth",
                    "give it those, or make it of triangles");
    Body body;
    body.spacing = spacing;
    body.fan = 4;
    GridSprings springs;
    const float stiffness[] = {settings.stiffness.structural, settings.stiffness.shear,
                               settings.stiffness.flexion};
    for (std::size_t l = 0; l < cloth_links.size(); ++l)
        springs.links.push_back(
            {cloth_links[l], stiffness[l / 4], spacing * glm::length(vec3(cloth_links[l]))});

    const ivec3 size(dims, 1);
    auto in_grid = [&](ivec3 p) {
        return glm::all(glm::greaterThanEqual(p, ivec3(0))) && glm::all(glm::lessThan(p, size));
    };
    for_each_place(size, [&](ivec3 p) {
        body.at.push_back(p);
        body.positions.push_back(spacing * vec3(p));
        std::uint64_t shares = 0;
        for (std::size_t l = 0; l < springs.links.size(); ++l)
            if (in_grid(p + springs.links[l].offset)) shares |= std::uint64_t(4) << 3 * l;
        springs.shares.push_back(shares);
        int squares = 0;
        for (int l = 4; l < 8; ++l) squares += in_grid(p + cloth_links[l]);  // the diagonals
        body.area.push_back(spacing * spacing * float(std::max(squares, 1)) / 4);

        const int i = int(body.at.size()) - 1, right = i + 1, up = i + dims.x;
        if (p.x + 1 == dims.x || p.y + 1 == dims.y) return;
        body.faces.push_back({i, right, up + 1});
        body.faces.push_back({i, up + 1, up});
    });
    body.terms = {std::move(springs)};
    weigh(body, settings);
    return body;
}

Body cloth(const Mesh& mesh, const ClothSettings& settings) {
    check(mesh, "the surface of a cloth");
    Body body;
    body.positions = mesh.positions;
    for (uvec3 t : mesh.triangles) body.faces.push_back({int(t.x), int(t.y), int(t.z)});
    const Thirds thirds = thirds_of(body);
    const std::vector<Ring> rings = rings_of(thirds);
    // One place more than an open ring has neighbours, so that its ends do not meet in the fan.
    for (const Ring& ring : rings) body.fan = std::max(body.fan, int(ring.nodes.size()) + !ring.closed);

    ListedSprings listed;
    auto add = [&](int a, int b, float stiffness) {
        listed.springs.push_back(
            {a, b, stiffness, glm::distance(mesh.positions[std::size_t(a)], mesh.positions[std::size_t(b)])});
    };
    for (int v = 0; v < int(rings.size()); ++v) {
        const Ring& ring = rings[std::size_t(v)];
        for (int n : ring.nodes)
            if (n > v) add(v, n, settings.stiffness.structural);
        body.rings.insert(body.rings.end(), ring.nodes.begin(), ring.nodes.end());
        body.rings.resize(std::size_t(v + 1) * std::size_t(body.fan), ring.closed ? ring.nodes[0] : -1);
    }
    body.area.assign(mesh.positions.size(), 0);
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const float third = glm::length(glm::cross(b - a, c - a)) / 6;
        for (int k = 0; k < 3; ++k) body.area[t[k]] += third;
    }
    for_each_fold(thirds, [&](int, int, int left, int right) {
        if (left < right && settings.stiffness.flexion > 0) add(left, right, settings.stiffness.flexion);
    });
    for (std::size_t v = 0; v < body.area.size(); ++v)
        if (!(body.area[v] > 0))
            throw Error(fmt::format("the faces at vertex {} have no area, so it has no mass", v), "the cloth",
                        "drop collapsed faces");
    body.spacing = mean_rest(listed.springs);
    body.terms = {std::move(listed)};
    weigh(body, settings);
    if (settings.bending > 0) body.terms.push_back(bending(body, settings.bending));
    return body;
}

Bending bending(const Body& sheet, float rigidity) {
    check(sheet);
    if (!(rigidity >= 0 && std::isfinite(rigidity)))
        throw Error(fmt::format("a bending of {} N m", rigidity), name_in_errors(sheet), "use 0 or more");
    Bending made;
    for_each_fold(thirds_of(sheet), [&](int from, int to, int left, int right) {
        if (from > to || left == right) return;  // once each; and back to back there is no way to bend
        auto at = [&](int node) { return dvec3(sheet.positions[std::size_t(node)]); };
        const dvec3 edge = at(to) - at(from), left_height = height(at(from), at(to), at(left)),
                    right_height = height(at(from), at(to), at(right));
        if (!(glm::length(left_height) > 0 && glm::length(right_height) > 0)) return;  // it has no normal
        const double mean = 0.5 * (glm::length(left_height) + glm::length(right_height)),
                     angle = fold_angle(edge, left_height, right_height);
        made.hinges.push_back({from, to, left, right, float(rigidity * glm::length(edge) / mean),
                               float(2 * std::sin(angle / 2))});
    });
    return made;
}

Body net(std::span<const vec3> positions, std::span<const float> masses, std::span<const Spring> springs,
         std::span<const uvec3> faces) {
    if (masses.size() != positions.size())
        throw Error(fmt::format("{} masses of {} nodes", masses.size(), positions.size()), "the net",
                    "give one a node");
    auto check = [&](long node) {
        if (node < 0 || node >= long(positions.size()))
            throw Error(fmt::format("node {} of {}", node, positions.size()), "the net",
                        "count nodes from 0");
    };
    Body body;
    body.positions.assign(positions.begin(), positions.end());
    for (float m : masses) body.inverse_mass.push_back(m > 0 ? 1 / m : 0);
    ListedSprings listed;
    for (Spring s : springs) {
        check(s.a);
        check(s.b);
        if (!(s.rest > 0)) s.rest = glm::distance(positions[std::size_t(s.a)], positions[std::size_t(s.b)]);
        listed.springs.push_back(s);
    }
    body.spacing = mean_rest(listed.springs);
    body.terms = {std::move(listed)};
    body.area.assign(positions.size(), 0);
    body.cover.assign(positions.size(), 0);
    for (uvec3 t : faces) {
        for (int k = 0; k < 3; ++k) check(t[k]);
        const vec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
        for (int k = 0; k < 3; ++k) body.area[t[k]] += glm::length(glm::cross(b - a, c - a)) / 6;
        body.faces.push_back({int(t.x), int(t.y), int(t.z)});
    }
    return body;
}

Mesh face_mesh(const Body& body) {
    Mesh mesh;
    mesh.positions = body.positions;
    for (const auto& f : body.faces) mesh.triangles.push_back({f[0], f[1], f[2]});
    compute_normals(mesh);
    return mesh;
}

}  // namespace palpate
