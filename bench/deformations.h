#pragma once
#include "palpate/body/cloth.h"
#include "palpate/body/embedding.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "tests/shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

// Deformations in closed form, bodies with a surface to deform, and how far a mapping is off. Shared by the
// tests and the tables of bench/.

namespace palpate {

/// A map of points, and its gradient.
struct Deformation {
    std::string name;
    std::function<dvec3(dvec3)> point;
    std::function<dmat3(dvec3)> gradient;

    vec3 operator()(vec3 p) const { return vec3(point(dvec3(p))); }
    /// The deformed normal n at p, by the cofactors of the gradient.
    vec3 normal(vec3 p, vec3 n) const {
        const dmat3 f = gradient(dvec3(p));
        return vec3(glm::normalize(double(n.x) * glm::cross(f[1], f[2]) +
                                   double(n.y) * glm::cross(f[2], f[0]) +
                                   double(n.z) * glm::cross(f[0], f[1])));
    }
    std::vector<vec3> operator()(const std::vector<vec3>& points) const {
        std::vector<vec3> moved;
        for (vec3 p : points) moved.push_back((*this)(p));
        return moved;
    }
};

/// Twists about the line through the origin along the unit vector `axis`, by `angle` radians for every
/// `length` along it.
inline Deformation twist(dvec3 axis, double length, double angle = M_PI / 2) {
    const double k = angle / length;
    auto turned = [=](dvec3 p) {
        const double a = k * glm::dot(axis, p);
        return std::cos(a) * p + std::sin(a) * glm::cross(axis, p) +
               (1 - std::cos(a)) * glm::dot(axis, p) * axis;
    };
    auto gradient = [=](dvec3 p) {
        const double a = k * glm::dot(axis, p);
        const dmat3 cross(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
        const dmat3 turn =
            std::cos(a) * dmat3(1) + std::sin(a) * cross + (1 - std::cos(a)) * glm::outerProduct(axis, axis);
        return turn + k * glm::outerProduct(glm::cross(axis, turned(p)), axis);
    };
    return {"twist", turned, gradient};
}

/// Bends the line through the origin along the unit vector `along` into an arc towards the unit vector
/// `toward`, by `angle` radians for every `length`.
inline Deformation bend(dvec3 along, dvec3 toward, double length, double angle = M_PI / 2) {
    const double radius = length / angle;
    auto point = [=](dvec3 p) {
        const double s = glm::dot(p, along), t = glm::dot(p, toward), a = s / radius;
        return p + ((radius - t) * std::sin(a) - s) * along +
               (radius - (radius - t) * std::cos(a) - t) * toward;
    };
    auto gradient = [=](dvec3 p) {
        const double s = glm::dot(p, along), t = glm::dot(p, toward), a = s / radius;
        const dvec3 over_s = (1 - t / radius) * (std::cos(a) * along + std::sin(a) * toward);
        const dvec3 over_t = std::cos(a) * toward - std::sin(a) * along;
        return dmat3(1) + glm::outerProduct(over_s - along, along) +
               glm::outerProduct(over_t - toward, toward);
    };
    return {"bend", point, gradient};
}

/// The deformation as far as a sheet at z = 0 can represent it: each point stays on the normal of the same
/// point of the sheet, at the same height.
inline Deformation of_a_sheet(const Deformation& d) {
    auto point = [d](dvec3 p) {
        const dmat3 f = d.gradient({p.x, p.y, 0});
        return d.point({p.x, p.y, 0}) + p.z * glm::normalize(glm::cross(f[0], f[1]));
    };
    auto gradient = [point](dvec3 p) {
        const double h = 1e-5;  // m; central differences, good to about 1e-9
        dmat3 f;
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 step(0);
            step[axis] = h;
            f[axis] = (point(p + step) - point(p - step)) / (2 * h);
        }
        return f;
    };
    return {d.name, point, gradient};
}

/// A deformed surface.
struct Moved {
    std::vector<vec3> positions, normals;
    std::vector<vec4> tangents;
};

inline Moved follow(const Embedding& skin, const Body& body, const std::vector<vec3>& nodes) {
    const std::vector<vec3> approximate = approximate_normals(body, nodes);
    Moved moved;
    deform(skin, {nodes, approximate}, moved.positions, moved.normals, &moved.tangents);
    return moved;
}

/// How far a surface is from where it should be. NaN if any vertex is.
struct Misfit {
    double rms = 0, largest = 0;               // of the positions, in the body's spacings
    double mean_angle = 0, largest_angle = 0;  // of the normals, degrees
};

inline Misfit misfit(const Moved& moved, const std::vector<vec3>& positions, const std::vector<vec3>& normals,
                     float spacing) {
    Misfit m;
    auto raise = [](double& most, double value) {
        if (!(value <= most)) most = value;
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double d = glm::distance(dvec3(moved.positions[i]), dvec3(positions[i])) / spacing;
        const dvec3 a(moved.normals[i]), b(normals[i]);
        const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / M_PI;
        m.rms += d * d;
        m.mean_angle += angle;
        raise(m.largest, d);
        raise(m.largest_angle, angle);
    }
    m.rms = std::sqrt(m.rms / double(positions.size()));
    m.mean_angle /= double(positions.size());
    return m;
}

/// A body with an embedded surface, and how the two are deformed in tests.
struct Carrier {
    std::string name;
    Mesh surface;
    Body body;
    Deformation twisted, bent;
};

inline Misfit misfit(const Carrier& c, const Embedding& skin, const Deformation& deformation) {
    std::vector<vec3> normals;
    for (std::size_t i = 0; i < c.surface.positions.size(); ++i)
        normals.push_back(deformation.normal(c.surface.positions[i], c.surface.normals[i]));
    return misfit(follow(skin, c.body, deformation(c.body.positions)), deformation(c.surface.positions),
                  normals, c.body.spacing);
}

/// An organ's shape on a lattice of 0.006 m.
inline Carrier organ_on_a_lattice() {
    Mesh mesh = ellipsoid({0.05f, 0.04f, 0.06f}, 40);
    Body body = lattice(mesh, {.spacing = 0.006f, .material = {.youngs_modulus = 5000, .density = 1000}});
    return {"ellipsoid on a lattice", mesh, body, twist({0, 0, 1}, 0.12), bend({0, 0, 1}, {1, 0, 0}, 0.12)};
}

/// A rectangle of z = height(x, y), centred on the origin.
template <class Height>
Mesh relief(vec2 size, ivec2 parts, Height height) {
    Mesh mesh;
    for (int j = 0; j <= parts.y; ++j)
        for (int i = 0; i <= parts.x; ++i) {
            const vec2 p = size * (vec2(i, j) / vec2(parts) - 0.5f);
            mesh.positions.emplace_back(p, height(p));
            mesh.uvs.push_back(vec2(i, j) / vec2(parts));
        }
    auto at = [&](int i, int j) { return unsigned(j * (parts.x + 1) + i); };
    for (int j = 0; j < parts.y; ++j)
        for (int i = 0; i < parts.x; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    compute_normals(mesh);
    return mesh;
}

/// A quilt 0.3 m wide, which hovers half a spacing to a whole one over a larger cloth.
inline Mesh quilt() {
    return relief({0.3f, 0.3f}, {90, 90},
                  [](vec2 p) { return 0.015f + 0.005f * std::sin(60 * p.x) * std::cos(50 * p.y); });
}

inline Carrier quilt_on_a_cloth() {
    Body body = cloth({17, 17}, 0.02f, {.density = 0.2f});
    for (vec3& p : body.positions) p -= vec3(0.16f, 0.16f, 0);
    return {"surface over a cloth (grid)", quilt(), body, of_a_sheet(twist({1, 0, 0}, 0.3)),
            bend({1, 0, 0}, {0, 0, -1}, 0.3)};
}

inline Carrier quilt_on_a_triangle_cloth() {
    Mesh mesh = relief({0.32f, 0.32f}, {15, 17}, [](vec2) { return 0.0f; });
    // Uneven triangles: inner nodes are moved off their rows.
    for (vec3& p : mesh.positions)
        if (std::max(std::abs(p.x), std::abs(p.y)) < 0.15f)
            p += 0.004f * vec3(std::sin(300 * p.x + 170 * p.y), std::sin(230 * p.x - 410 * p.y), 0);
    mesh.normals.clear();
    return {"surface over a cloth (triangles)", quilt(), cloth(mesh, {.density = 0.2f}),
            of_a_sheet(twist({1, 0, 0}, 0.3)), bend({1, 0, 0}, {0, 0, -1}, 0.3)};
}

/// A net of the nodes of a grid about the origin, with springs along axes and diagonals, and the hull as
/// faces.
inline Body grid_net(ivec3 dims, float spacing) {
    const Body box = lattice(dims, spacing, {.stiffness = 100, .mass = 1});
    std::vector<Spring> springs;
    for (uvec2 ends : spring_ends(box)) springs.push_back({int(ends.x), int(ends.y), 100});
    std::vector<uvec3> faces;
    for (const HullTriangle& t : hull(box)) faces.emplace_back(t.nodes[0], t.nodes[1], t.nodes[2]);
    std::vector<vec3> positions;
    for (vec3 p : box.positions) positions.push_back(p - 0.5f * spacing * vec3(dims - 1));
    return net(positions, std::vector<float>(positions.size(), 0.1f), springs, faces);
}

/// A detailed surface on a net of 18 nodes, like the dragon of 2005, with bumps beyond the net.
inline Carrier beast_on_18_nodes() {
    Body body = grid_net({2, 3, 3}, 0.1f);
    body.spacing = 0.1f;
    Mesh mesh = ellipsoid({0.1f, 0.14f, 0.16f}, 60);
    for (vec3& p : mesh.positions)
        p *= 1 + 0.08f * std::sin(60 * p.x) * std::sin(45 * p.y) * std::sin(50 * p.z);
    compute_normals(mesh);
    return {"beast on a net of 18 nodes", mesh, body, twist({0, 0, 1}, 0.32),
            bend({0, 0, 1}, {1, 0, 0}, 0.32)};
}

/// A detailed surface on a sheet of 6 × 3 nodes through its middle, as in scenes/dragon.toml.
inline Carrier on_a_sheet_of_18(const std::string& name, const Mesh& surface) {
    const Bounds box = bounds(surface);
    const float spacing = 0.206f * box.size().x;
    Mesh mesh = surface;
    for (vec3& p : mesh.positions) p -= box.centre();
    compute_normals(mesh);
    Body body = cloth({6, 3}, spacing, {.density = 1});
    for (vec3& p : body.positions) p -= 0.5f * spacing * vec3(5, 2, 0);
    const double length = 5 * double(spacing);
    return {name + " on a sheet of 18 nodes", mesh, body, of_a_sheet(twist({1, 0, 0}, length)),
            bend({1, 0, 0}, {0, 0, -1}, length)};
}

inline Mesh beast() {
    Mesh mesh = ellipsoid({0.1f, 0.07f, 0.045f}, 60);
    for (vec3& p : mesh.positions)
        p *= 1 + 0.08f * std::sin(60 * p.x) * std::sin(45 * p.y) * std::sin(50 * p.z);
    return mesh;
}

inline std::vector<Carrier> carriers() {
    return {organ_on_a_lattice(), quilt_on_a_cloth(), quilt_on_a_triangle_cloth(), beast_on_18_nodes(),
            on_a_sheet_of_18("beast", beast())};
}

}  // namespace palpate
