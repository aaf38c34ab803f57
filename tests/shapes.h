#pragma once
#include "palpate/mesh/mesh.h"

#include <array>
#include <cmath>
#include <string>

// Closed surfaces whose shape is known, for tests.

/// An ellipsoid around the origin, of `rings` times 2 · rings quadrilaterals cut in two.
inline palpate::Mesh ellipsoid(palpate::vec3 radii, int rings) {
    using namespace palpate;
    Mesh mesh;
    const int around = 2 * rings;
    const float pi = 3.14159265f;
    mesh.positions.push_back({0, 0, radii.z});
    for (int r = 1; r < rings; ++r)
        for (int a = 0; a < around; ++a) {
            const float polar = pi * r / rings, turn = 2 * pi * a / around;
            mesh.positions.push_back(radii * vec3(std::sin(polar) * std::cos(turn),
                                                  std::sin(polar) * std::sin(turn), std::cos(polar)));
        }
    mesh.positions.push_back({0, 0, -radii.z});
    const unsigned last = unsigned(mesh.positions.size()) - 1;
    auto at = [&](int r, int a) { return unsigned(1 + (r - 1) * around + a % around); };
    for (int a = 0; a < around; ++a) {
        mesh.triangles.push_back({0u, at(1, a), at(1, a + 1)});
        mesh.triangles.push_back({last, at(rings - 1, a + 1), at(rings - 1, a)});
        for (int r = 1; r + 1 < rings; ++r) {
            mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
            mesh.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
        }
    }
    compute_normals(mesh);
    return mesh;
}

/// A box; its edges are cut into `parts`, so that it has vertices on its faces too. Vertices are not shared
/// between faces, so normals are sharp.
inline palpate::Mesh block(palpate::vec3 low, palpate::vec3 high, int parts = 4) {
    using namespace palpate;
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const unsigned first = unsigned(mesh.positions.size());
            for (int j = 0; j <= parts; ++j)
                for (int i = 0; i <= parts; ++i) {
                    vec3 p;
                    p[axis] = side ? high[axis] : low[axis];
                    p[u] = glm::mix(low[u], high[u], float(i) / parts);
                    p[v] = glm::mix(low[v], high[v], float(j) / parts);
                    mesh.positions.push_back(p);
                    vec3 n(0);
                    n[axis] = side ? 1.0f : -1.0f;
                    mesh.normals.push_back(n);
                }
            auto at = [&](int i, int j) { return first + unsigned(j * (parts + 1) + i); };
            for (int j = 0; j < parts; ++j)
                for (int i = 0; i < parts; ++i) {
                    uvec3 a(at(i, j), at(i + 1, j), at(i + 1, j + 1)),
                        b(at(i, j), at(i + 1, j + 1), at(i, j + 1));
                    if (!side) std::swap(a.y, a.z), std::swap(b.y, b.z);
                    mesh.triangles.push_back(a);
                    mesh.triangles.push_back(b);
                }
        }
    return mesh;
}

/// One mesh of two.
inline palpate::Mesh both(palpate::Mesh a, const palpate::Mesh& b) {
    const unsigned shift = unsigned(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    for (palpate::uvec3 t : b.triangles) a.triangles.push_back(t + shift);
    return a;
}

/// A cube from 0 to 1 as an OBJ file of six quads that each have a strip of a texture: quad q from u = q/8
/// on, a tenth wide, v from 0 to 1. So each of its corners has three places there.
inline std::string textured_cube(bool uvs = true) {
    constexpr std::array<std::array<int, 4>, 6> quads = {
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    std::string text, faces;
    for (int i = 0; i < 8; ++i)
        text += "v " + std::to_string(i & 1) + ' ' + std::to_string(i >> 1 & 1) + ' ' +
                std::to_string(i >> 2) + '\n';
    for (int q = 0; q < 6; ++q) {
        faces += 'f';
        for (int k = 0; k < 4; ++k) {
            const bool right = k == 1 || k == 2, up = k > 1;
            if (uvs) text += "vt " + std::to_string(q / 8.0 + 0.1 * right) + ' ' + std::to_string(up) + '\n';
            faces += ' ' + std::to_string(quads[std::size_t(q)][std::size_t(k)] + 1);
            if (uvs) faces += '/' + std::to_string(4 * q + k + 1);
        }
        faces += '\n';
    }
    return text + faces;
}
