#include "palpate/mesh/mesh.h"

#include "palpate/base/error.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// The unit vector along v; zero if v is zero.
vec3 unit(vec3 v) {
    float length = glm::length(v);
    return length > 0 ? v / length : vec3(0);
}

// The angle between two unit vectors, by a formula that is exact near 0 and 180 degrees, too.
float angle(vec3 a, vec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

}  // namespace

std::span<const Named<Units>> names(Units) {
    static constexpr Named<Units> all[] = {{Units::metres, "m"},
                                           {Units::centimetres, "cm"},
                                           {Units::millimetres, "mm"},
                                           {Units::micrometres, "um"}};
    return all;
}

float metres(Units units) {
    switch (units) {
        case Units::metres:
            return 1;
        case Units::centimetres:
            return 1e-2f;
        case Units::millimetres:
            return 1e-3f;
        case Units::micrometres:
            return 1e-6f;
    }
    return 1;
}

double volume(const Mesh& mesh) {
    // Any point may be the tip of the tetrahedra; a central one keeps the terms small.
    const dvec3 tip = mesh.positions.empty() ? dvec3(0) : dvec3(bounds(mesh).centre());
    double six_volumes = 0;
    for (uvec3 t : mesh.triangles) {
        dvec3 a = dvec3(mesh.positions[t.x]) - tip;
        dvec3 b = dvec3(mesh.positions[t.y]) - tip;
        dvec3 c = dvec3(mesh.positions[t.z]) - tip;
        six_volumes += glm::dot(a, glm::cross(b, c));
    }
    return six_volumes / 6;
}

void compute_normals(Mesh& mesh) { compute_normals(mesh.positions, mesh.triangles, mesh.normals); }

void compute_normals(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles,
                     std::vector<vec3>& normals) {
    normals.assign(positions.size(), vec3(0));
    for (uvec3 t : triangles) {
        // Normalised sides first, so that products of small lengths do not underflow.
        const vec3 sides[] = {positions[t.y] - positions[t.x], positions[t.z] - positions[t.y],
                              positions[t.x] - positions[t.z]};
        const vec3 ab = unit(sides[0]), bc = unit(sides[1]), ca = unit(sides[2]);
        const float lengths[] = {glm::length(sides[0]), glm::length(sides[1]), glm::length(sides[2])};
        const float longest = std::max({lengths[0], lengths[1], lengths[2]});
        if (!(longest > 0)) continue;
        // Twice the area of the face scaled to a longest side of 1: near 0 for a sliver, whose normal is
        // unreliable.
        const float roundness =
            (lengths[0] / longest) * (lengths[1] / longest) * glm::length(glm::cross(ab, bc));
        const vec3 face = std::min(4 * roundness, 1.0f) * unit(glm::cross(ab, bc));
        normals[t.x] += face * angle(ab, -ca);
        normals[t.y] += face * angle(bc, -ab);
        normals[t.z] += face * angle(ca, -bc);
    }
    for (vec3& n : normals) {
        n = unit(n);
        if (n == vec3(0)) n = vec3(0, 0, 1);
    }
}

void compute_normals_by_place(Mesh& mesh) {
    const std::vector<std::uint32_t> first = first_in_place(mesh.positions);
    std::vector<uvec3> triangles;
    for (uvec3 t : mesh.triangles) triangles.push_back({first[t.x], first[t.y], first[t.z]});
    compute_normals(mesh.positions, triangles, mesh.normals);
    for (std::size_t i = 0; i < first.size(); ++i) mesh.normals[i] = mesh.normals[first[i]];
}

void check(const Mesh& mesh, std::string_view where) {
    const std::size_t count = mesh.positions.size();
    auto fits = [&](const auto& list) { return list.empty() || list.size() == count; };
    if (!fits(mesh.normals) || !fits(mesh.uvs) || !fits(mesh.tangents))
        throw Error(
            "a number of normals, texture coordinates or tangents that differs from that of the vertices",
            where, "give every vertex one, or none at all");
    for (uvec3 t : mesh.triangles)
        if (std::max({t.x, t.y, t.z}) >= count)
            throw Error("a triangle that refers to a missing vertex", where, "count vertices from 0");
    for (vec3 p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw Error("a vertex position that is not finite", where, "give positions in m");
}

void compute_tangents(Mesh& mesh) {
    check(mesh, "the mesh that needs tangents");
    if (mesh.uvs.size() != mesh.positions.size())
        throw Error("no texture coordinates", "the mesh that needs tangents", "give every vertex some");
    if (mesh.normals.size() != mesh.positions.size()) compute_normals(mesh);
    std::vector<vec3> along_u(mesh.positions.size(), vec3(0)), along_v = along_u;
    for (uvec3 t : mesh.triangles) {
        const vec3 ab = mesh.positions[t.y] - mesh.positions[t.x];
        const vec3 ac = mesh.positions[t.z] - mesh.positions[t.x];
        const vec2 uv_ab = mesh.uvs[t.y] - mesh.uvs[t.x], uv_ac = mesh.uvs[t.z] - mesh.uvs[t.x];
        // The derivatives of position by u and v in the face (its Jacobian); of the area in the texture only
        // the sign counts.
        const float area = uv_ab.x * uv_ac.y - uv_ac.x * uv_ab.y;
        const float sign = area > 0 ? 1.0f : area < 0 ? -1.0f : 0.0f;
        const vec3 u = sign * unit(ab * uv_ac.y - ac * uv_ab.y), v = sign * unit(ac * uv_ab.x - ab * uv_ac.x);
        for (int k = 0; k < 3; ++k) {
            const vec3 corner = mesh.positions[t[k]];
            const float weight = angle(unit(mesh.positions[t[(k + 1) % 3]] - corner),
                                       unit(mesh.positions[t[(k + 2) % 3]] - corner));
            along_u[t[k]] += weight * u;
            along_v[t[k]] += weight * v;
        }
    }
    mesh.tangents.clear();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 n = mesh.normals[i];
        vec3 tangent = unit(along_u[i] - glm::dot(along_u[i], n) * n);
        if (tangent == vec3(0))
            tangent = unit(glm::cross(n, std::abs(n.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
        const float handedness = glm::dot(glm::cross(n, tangent), along_v[i]) < 0 ? -1.0f : 1.0f;
        mesh.tangents.emplace_back(tangent, handedness);
    }
}

void rotate(Mesh& mesh, vec3 degrees) {
    const dvec3 angle = glm::radians(dvec3(degrees));
    const dvec3 c = glm::cos(angle), s = glm::sin(angle);
    // Columns, as in glm.
    const dmat3 about_x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);
    const dmat3 about_y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
    const dmat3 about_z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    const mat3 turn(about_z * about_y * about_x);
    for (vec3& p : mesh.positions) p = turn * p;
    for (vec3& n : mesh.normals) n = turn * n;
    for (vec4& t : mesh.tangents) t = vec4(turn * vec3(t), t.w);
}

}  // namespace palpate
