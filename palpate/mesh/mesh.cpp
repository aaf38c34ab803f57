#include "palpate/mesh/mesh.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Of length one; zero if v has no direction.
vec3 unit(vec3 v) {
    float length = glm::length(v);
    return length > 0 ? v / length : vec3(0);
}

// The angle between two unit vectors, by the form that stays exact near 0 and 180 degrees.
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

Bounds bounds(const Mesh& mesh) {
    Bounds box;
    for (vec3 p : mesh.positions) box.include(p);
    return box;
}

double volume(const Mesh& mesh) {
    // Any point serves as the tip of the tetrahedra; one amid them keeps the terms small.
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
        // Sides of length one first: so no product of small lengths gets lost, however small the face.
        const vec3 sides[] = {positions[t.y] - positions[t.x], positions[t.z] - positions[t.y],
                              positions[t.x] - positions[t.z]};
        const vec3 ab = unit(sides[0]), bc = unit(sides[1]), ca = unit(sides[2]);
        const float lengths[] = {glm::length(sides[0]), glm::length(sides[1]), glm::length(sides[2])};
        const float longest = std::max({lengths[0], lengths[1], lengths[2]});
        if (!(longest > 0)) continue;
        // Twice the area of the face scaled to a longest side of 1: near 0 for a sliver, whose normal is
        // mostly chance.
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

void rotate(Mesh& mesh, vec3 degrees) {
    const dvec3 angle = glm::radians(dvec3(degrees));
    const dvec3 c = glm::cos(angle), s = glm::sin(angle);
    // Columns, as glm has them.
    const dmat3 about_x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);
    const dmat3 about_y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
    const dmat3 about_z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    const mat3 turn(about_z * about_y * about_x);
    for (vec3& p : mesh.positions) p = turn * p;
    for (vec3& n : mesh.normals) n = turn * n;
}

}  // namespace palpate
