#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/soundness.h"
#include "palpate/mesh/volume.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace palpate {

/// A closed box from `low` to `high`.
inline Mesh box(vec3 low, vec3 high) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(glm::mix(low, high, glm::bvec3(i & 1, i & 2, i & 4)));
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// A closed sphere: an octahedron whose faces are cut in four, `level` times.
inline Mesh sphere(vec3 centre, float radius, int level) {
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (; level > 0; --level) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        auto middle = [&](unsigned a, unsigned b) {
            auto [at, added] = middles.try_emplace(std::pair(std::min(a, b), std::max(a, b)),
                                                   unsigned(mesh.positions.size()));
            if (added) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
            return at->second;
        };
        std::vector<uvec3> finer;
        for (uvec3 t : mesh.triangles) {
            const unsigned a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {a, t.y, b}, {c, b, t.z}, {a, b, c}});
        }
        mesh.triangles = finer;
    }
    for (vec3& p : mesh.positions) p = centre + radius * p;
    return mesh;
}

/// The same faces, the other way round.
inline Mesh inside_out(Mesh mesh) {
    for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    return mesh;
}

/// The same faces, each with three vertices of its own.
inline Mesh soup(const Mesh& mesh) {
    Mesh apart;
    for (uvec3 t : mesh.triangles) {
        const unsigned n = unsigned(apart.positions.size());
        apart.positions.insert(apart.positions.end(),
                               {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
        apart.triangles.push_back({n, n + 1, n + 2});
    }
    return apart;
}

inline double area(const Mesh& mesh) {
    double sum = 0;
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x];
        sum += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    }
    return sum;
}

/// A torus around z: `large` from its middle to that of its tube, `small` the radius of the tube.
inline Mesh torus(float large, float small, unsigned around, unsigned across) {
    Mesh mesh;
    const float whole = 2 * float(M_PI);
    for (unsigned i = 0; i < around; ++i)
        for (unsigned j = 0; j < across; ++j) {
            const float a = whole * float(i) / float(around), b = whole * float(j) / float(across);
            const float r = large + small * std::cos(b);
            mesh.positions.push_back({r * std::cos(a), r * std::sin(a), small * std::sin(b)});
            const unsigned ni = (i + 1) % around, nj = (j + 1) % across;
            mesh.triangles.push_back({i * across + j, ni * across + j, ni * across + nj});
            mesh.triangles.push_back({i * across + j, ni * across + nj, i * across + nj});
        }
    return mesh;
}

/// A band of this width that is turned over `half_turns` times on its way round; with an odd number it has
/// one side only.
inline Mesh band(float width, int half_turns, unsigned around) {
    Mesh mesh;
    for (unsigned i = 0; i < around; ++i) {
        const float a = 2 * float(M_PI) * float(i) / float(around), b = 0.5f * float(half_turns) * a;
        for (float side : {-0.5f, 0.5f}) {
            const float r = 1 + side * width * std::cos(b);
            mesh.positions.push_back({r * std::cos(a), r * std::sin(a), side * width * std::sin(b)});
        }
        const bool crossed = i + 1 == around && half_turns % 2 != 0;
        const unsigned next = 2 * ((i + 1) % around), low = next + crossed, high = next + !crossed;
        mesh.triangles.push_back({2 * i, low, high});
        mesh.triangles.push_back({2 * i, high, 2 * i + 1});
    }
    return mesh;
}

/// A volume of one metre a voxel whose values are f(voxel).
template <class F>
Volume volume_of(ivec3 dims, F f) {
    Volume volume;
    volume.dims = dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) volume.values.push_back(f(vec3(x, y, z)));
    return volume;
}

/// Random values from 0 to 1: nearly every voxel's neighbourhood is a case of its own.
inline Volume rubble(ivec3 dims, unsigned seed) {
    std::mt19937 random(seed);
    return volume_of(dims, [&](vec3) { return std::uniform_real_distribution<float>(0, 1)(random); });
}

/// Finite, and with two faces at every edge, which run along it in opposite ways.
inline void expect_closed(const Mesh& mesh) {
    const Soundness found = soundness(mesh);
    EXPECT_EQ(found.open_edges, 0u);
    EXPECT_EQ(found.bad_edges, 0u);
    for (vec3 p : mesh.positions) ASSERT_LE(glm::length(p), 1e9f);
}

}  // namespace palpate
