#include "palpate/mesh/intersections.h"

#include "palpate/base/parallel.h"
#include "palpate/mesh/soundness.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <set>

namespace palpate {
namespace {

// Where a segment meets a triangle's plane, in the triangle's own coordinates: another way to the same
// answer.
bool pierces(dvec3 p, dvec3 q, dvec3 a, dvec3 b, dvec3 c) {
    const dmat3 axes(b - a, c - a, p - q);
    if (glm::determinant(axes) == 0) return false;
    const dvec3 at = glm::inverse(axes) * (p - a);
    return at.x > 0 && at.y > 0 && at.x + at.y < 1 && at.z > 0 && at.z < 1;
}

bool cut(const Mesh& mesh, uvec3 s, uvec3 t) {
    for (int k = 0; k < 3; ++k) {
        auto at = [&](unsigned v) { return dvec3(mesh.positions[v]); };
        if (pierces(at(s[k]), at(s[(k + 1) % 3]), at(t.x), at(t.y), at(t.z)) ||
            pierces(at(t[k]), at(t[(k + 1) % 3]), at(s.x), at(s.y), at(s.z)))
            return true;
    }
    return false;
}

using Pairs = std::set<std::pair<unsigned, unsigned>>;

Pairs found_in(const Mesh& mesh) {
    Pairs pairs;
    for (uvec2 pair : intersections(mesh).faces) {
        const bool added = pairs.insert(std::minmax(pair.x, pair.y)).second;
        EXPECT_TRUE(added) << "each pair once";
    }
    return pairs;
}

TEST(Intersections, AsEachPairByItself) {
    for (unsigned seed = 0; seed < 12; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> any(-1, 1);
        // Every other soup shares its vertices, so that many faces are neighbours.
        Mesh mesh;
        const unsigned faces = 150 + 20 * seed, vertices = seed % 2 ? faces / 4 : 3 * faces;
        const float size = seed % 2 ? 1 : 0.4f;
        vec3 middle(0);
        for (unsigned v = 0; v < vertices; ++v) {
            if (v % 3 == 0) middle = vec3(any(random), any(random), any(random));
            mesh.positions.push_back(middle + size * vec3(any(random), any(random), any(random)));
        }
        for (unsigned f = 0; f < faces; ++f)
            if (seed % 2)
                mesh.triangles.push_back({unsigned(random()) % vertices, unsigned(random()) % vertices,
                                          unsigned(random()) % vertices});
            else
                mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
        std::erase_if(mesh.triangles, [](uvec3 t) { return t.x == t.y || t.y == t.z || t.z == t.x; });

        // Neighbours cut each other where the side across from what they share does; random numbers put no
        // corner exactly on a plane but those of shared corners, which rounding puts on either side.
        Pairs expected;
        for (unsigned i = 0; i < mesh.triangles.size(); ++i)
            for (unsigned j = i + 1; j < mesh.triangles.size(); ++j) {
                const uvec3 s = mesh.triangles[i], t = mesh.triangles[j];
                std::vector<unsigned> shared;
                for (int k = 0; k < 3; ++k)
                    if (s[k] == t.x || s[k] == t.y || s[k] == t.z) shared.push_back(s[k]);
                auto across = [&](uvec3 face) {
                    while (face.x != shared[0]) face = {face.y, face.z, face.x};
                    return face;
                };
                auto at = [&](unsigned v) { return dvec3(mesh.positions[v]); };
                bool cuts = false;
                if (shared.empty()) {
                    cuts = cut(mesh, s, t);
                } else if (shared.size() == 1) {
                    const uvec3 a = across(s), b = across(t);
                    cuts = pierces(at(a.y), at(a.z), at(t.x), at(t.y), at(t.z)) ||
                           pierces(at(b.y), at(b.z), at(s.x), at(s.y), at(s.z));
                }
                if (cuts) expected.insert({i, j});
            }
        EXPECT_GT(expected.size(), 20u);
        EXPECT_EQ(found_in(mesh), expected) << seed;
    }
}

TEST(Intersections, NoneInSoundShapes) {
    EXPECT_TRUE(found_in(box(vec3(0), vec3(1))).empty());
    EXPECT_TRUE(found_in(torus(2, 0.7f, 61, 37)).empty());
    EXPECT_TRUE(found_in(sphere(vec3(1e3f), 1, 5)).empty());
    EXPECT_TRUE(found_in(both(box(vec3(0), vec3(1)), box(vec3(1, 0, 0), vec3(2)))).empty()) << "they touch";
    EXPECT_TRUE(found_in(Mesh{}).empty());
}

TEST(Intersections, SizeDoesNotMatter) {
    const Mesh two = both(sphere(vec3(0), 1, 3), sphere(vec3(0.7f), 1, 3));
    const Pairs expected = found_in(two);
    EXPECT_GT(expected.size(), 40u);
    for (int power : {-66, 60, 99}) {
        Mesh other = two;
        for (vec3& p : other.positions) p *= std::ldexp(1.0f, power);
        EXPECT_EQ(found_in(other), expected);
    }
}

TEST(Intersections, GivesUpRatherThanHang) {
    // A thin cone of 40,000 needles, every one in the box of nearly every other.
    Mesh cone{{vec3(0)}, {}, {}};
    const unsigned n = 40'000;
    for (unsigned i = 0; i < n; ++i) {
        const float a = 2 * float(M_PI) * float(i) / float(n);
        cone.positions.push_back(
            {1 + 0.1f * std::cos(a), 1 + 0.1f * std::sin(a), 1 + 0.1f * std::cos(2 * a)});
        cone.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    EXPECT_TRUE(intersections(cone).faces.empty());
    const Mesh two = both(sphere(vec3(0), 1, 5), sphere(vec3(0.5f), 1, 5));
    EXPECT_FALSE(intersections(two, 10).all);
    EXPECT_TRUE(intersections(two).all);
}

TEST(Intersections, AreTheSameByAnyNumberOfThreads) {
    const Mesh two = both(sphere(vec3(0), 1, 6), sphere(vec3(0.5f), 1, 6));
    for (std::size_t most : {std::size_t(10), std::size_t(1'000'000)}) {
        const Intersections by_many = intersections(two, most);
        const Processors one(1);
        const Intersections by_one = intersections(two, most);
        EXPECT_EQ(by_many.faces, by_one.faces);
        EXPECT_EQ(by_many.all, by_one.all);
    }
}

TEST(MendIntersections, FlattensAFewSpikes) {
    // Vertices pushed right through the far side of a ball.
    Mesh mesh = sphere(vec3(0), 1, 6);
    const double before = volume(mesh);
    for (unsigned v : {7u, 500u, 3000u}) mesh.positions[v] *= -1.02f;
    const Intersections found = intersections(mesh);
    ASSERT_GT(found.faces.size(), 0u);
    EXPECT_GT(mend_intersections(mesh, found), 0u);
    EXPECT_TRUE(intersections(mesh).faces.empty());
    EXPECT_TRUE(soundness(mesh).closed());
    EXPECT_TRUE(std::abs(volume(mesh) / before - 1) <= 0.02);
}

TEST(MendIntersections, LeavesWhatItCannotMend) {
    const Mesh two = both(sphere(vec3(0), 1, 3), sphere(vec3(0.7f), 1, 3));
    Mesh mesh = two;
    EXPECT_EQ(mend_intersections(mesh, intersections(mesh)), 0u);
    EXPECT_EQ(mesh.triangles, two.triangles);
    EXPECT_EQ(mesh.positions, two.positions);
}

}  // namespace
}  // namespace palpate
