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

std::vector<Ring> rings_of(const Mesh& mesh) {
    std::vector<std::map<int, int>> next(mesh.positions.size());
    auto add = [&](unsigned vertex, unsigned a, unsigned b) {
        if (!next[vertex].emplace(a, b).second)
            throw Error(fmt::format("three faces or more meet at the edge from vertex {} to {}", vertex, a),
                        "the cloth", "drop double faces, and turn all faces the same way");
    };
    for (uvec3 t : mesh.triangles) {
        add(t.x, t.y, t.z);
        add(t.y, t.z, t.x);
        add(t.z, t.x, t.y);
    }
    std::vector<Ring> rings;
    for (std::size_t v = 0; v < next.size(); ++v) rings.push_back(ring_of(v, next[v]));
    return rings;
}

}  // namespace

Body cloth(ivec2 dims, float spacing, const ClothSettings& settings) {
    if (std::min(dims.x, dims.y) < 1 || double(dims.x) * dims.y > 3e7)
        throw Error(fmt::format("{} x {} nodes", dims.x, dims.y), "the cloth",
                    "use fewer than 30 million, and 1 or more along each side");
    if (!(spacing > 0 && std::isfinite(spacing)))
        throw Error(fmt::format("a spacing of {} m", spacing), "the cloth", "use one above zero");
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
    const std::vector<Ring> rings = rings_of(mesh);
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
    std::map<std::pair<unsigned, unsigned>, unsigned> opposite;  // of each directed edge
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const float third = glm::length(glm::cross(b - a, c - a)) / 6;
        for (int k = 0; k < 3; ++k) {
            body.area[t[k]] += third;
            opposite[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
        }
        body.faces.push_back({int(t.x), int(t.y), int(t.z)});
    }
    for (const auto& [edge, mine] : opposite) {
        const auto other = opposite.find({edge.second, edge.first});
        if (other == opposite.end() || settings.stiffness.flexion <= 0) continue;
        if (mine < other->second) add(int(mine), int(other->second), settings.stiffness.flexion);
    }
    for (std::size_t v = 0; v < body.area.size(); ++v)
        if (!(body.area[v] > 0))
            throw Error(fmt::format("the faces at vertex {} have no area, so it has no mass", v), "the cloth",
                        "drop collapsed faces");
    body.spacing = mean_rest(listed.springs);
    body.terms = {std::move(listed)};
    weigh(body, settings);
    return body;
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
