#include "palpate/mesh/winding_number.h"

#include "palpate/base/parallel.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

double exact(const Mesh& mesh, dvec3 point) {
    double sum = 0;
    for (uvec3 t : mesh.triangles)
        sum += solid_angle(point, dvec3(mesh.positions[t.x]), dvec3(mesh.positions[t.y]),
                           dvec3(mesh.positions[t.z]));
    return sum;
}

// Points in and around the box from -2 to 2.
std::vector<dvec3> points(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-2, 2);
    std::vector<dvec3> result;
    for (int i = 0; i < count; ++i) result.emplace_back(any(random), any(random), any(random));
    return result;
}

TEST(SolidAngle, OfACubesFaceFromItsMiddle) {
    const double half = 0.5;
    const double sum =
        solid_angle(dvec3(0), dvec3(-half, -half, half), dvec3(half, -half, half), dvec3(half, half, half));
    EXPECT_NEAR(sum, 1.0 / 12, 1e-15);
    EXPECT_EQ(solid_angle(dvec3(1, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)), 0);
}

TEST(ExactWinding, IsTheSumOfSolidAngles) {
    const Mesh ball = sphere(vec3(0), 1.5f, 6);  // more faces than one processor sums at once
    std::vector<Index> all(ball.triangles.size()), half;
    for (Index face = 0; face < all.size(); ++face) {
        all[face] = face;
        if (face % 2 == 0) half.push_back(face);
    }
    Mesh half_ball{ball.positions, {}, {}};
    for (Index face : half) half_ball.triangles.push_back(ball.triangles[face]);
    for (dvec3 p : points(50, 3)) {
        EXPECT_NEAR(exact_winding(ball, all, p), exact(ball, p), 1e-9);
        EXPECT_NEAR(exact_winding(ball, half, p), exact(half_ball, p), 1e-9);
    }
    EXPECT_EQ(exact_winding(ball, {}, dvec3(0)), 0);
    // Half a turn, which each face of an octahedron inside out adds to: exactly, as no angle is rounded.
    const Mesh octahedron = inside_out(sphere(vec3(0), 1, 0));
    std::vector<Index> eight = {0, 1, 2, 3, 4, 5, 6, 7};
    EXPECT_EQ(exact_winding(octahedron, eight, dvec3(0)), -1);
}

TEST(WindingNumber, OfClosedSurfacesIsWhole) {
    const Mesh nested = both(sphere(vec3(0), 1.5f, 5), sphere(vec3(0.1f), 1, 4));
    const Tree tree(nested);
    const WindingNumber winding(tree);
    for (dvec3 p : points(2000, 1)) {
        const double outer = glm::length(p) - 1.5, inner = glm::distance(p, dvec3(0.1)) - 1;
        if (std::abs(outer) < 0.01 || std::abs(inner) < 0.01) continue;
        const double expected = (outer < 0) + (inner < 0);
        EXPECT_TRUE(std::abs(winding.at(p) - expected) <= 0.05) << winding.at(p) << " for " << expected;
    }
}

// Open, one-sided, closed, and a soup of faces anywhere.
Mesh any_triangles(unsigned seed) {
    if (seed == 0) return band(0.8f, 1, 200);
    if (seed == 1) return torus(1.2f, 0.5f, 90, 40);
    Mesh mesh;
    std::mt19937 random(seed);
    std::normal_distribution<float> any(0, 1);
    for (unsigned i = 0; i < 300 * seed; ++i) {
        const vec3 at(any(random), any(random), any(random));
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(at + 0.2f * vec3(any(random), any(random), any(random)));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// Asks `at` for the winding number of points in and around many a mesh.
template <class F>
void expect_near_the_exact_sum(F at) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        const Mesh mesh = any_triangles(seed);
        const Tree tree(mesh);
        const WindingNumber winding(tree);
        double squares = 0;
        const std::vector<dvec3> all = points(400, seed);
        for (dvec3 p : all) {
            const double error = at(winding, p) - exact(mesh, p);
            EXPECT_TRUE(std::abs(error) <= 0.05) << error;
            squares += error * error;
        }
        EXPECT_TRUE(std::sqrt(squares / double(all.size())) <= 0.01);
    }
}

TEST(WindingNumber, IsNearTheExactSumForAnyTriangles) {
    expect_near_the_exact_sum([](const WindingNumber& winding, dvec3 p) { return winding.at(p); });
}

TEST(WindingNumber, InABallIsAsNear) {
    expect_near_the_exact_sum([](const WindingNumber& winding, dvec3 p) {
        // Balls in balls, the point at the rim of the last, where its slope errs most.
        const dvec3 off = glm::normalize(dvec3(1, -2, 0.5) + p);
        WindingNumber::Ball ball = winding.ball(p + 0.8 * off, 0.8);
        for (double radius = 0.4; radius > 0.01; radius /= 2)
            ball = winding.ball(p + radius * off, radius, ball);
        return winding.at(p, ball);
    });
    const Mesh nothing;
    const Tree tree(nothing);
    const WindingNumber winding(tree);
    EXPECT_EQ(winding.at(dvec3(0), winding.ball(dvec3(0), 1)), 0);
}

TEST(WindingNumber, DoesNotMindSize) {
    for (float scale : {1e-20f, 1e30f}) {
        Mesh mesh = sphere(vec3(0), 1, 4);
        for (vec3& p : mesh.positions) p *= scale;
        const Tree tree(mesh);
        const WindingNumber winding(tree);
        EXPECT_TRUE(std::abs(winding.at(dvec3(0.3 * double(scale))) - 1) <= 0.02);
        EXPECT_TRUE(std::abs(winding.at(dvec3(0.8 * double(scale)))) <= 0.02);
    }
    const Mesh nothing;
    const Tree tree(nothing);
    EXPECT_EQ(WindingNumber(tree).at(dvec3(0)), 0);
}

TEST(Tree, FindsTheNearestFace) {
    const Mesh mesh = torus(1.2f, 0.5f, 50, 31);
    const Tree tree(mesh);
    for (dvec3 p : points(2000, 9)) {
        const double exact = std::abs(std::hypot(std::hypot(p.x, p.y) - 1.2, p.z) - 0.5);
        const double found = double(tree.distance(vec3(p), 10));
        EXPECT_TRUE(std::abs(found - exact) <= 0.01) << found << " for " << exact;
        EXPECT_EQ(tree.distance(vec3(p), 0.25f), std::min(float(found), 0.25f));
    }
}

TEST(Tree, HalvesItsFacesBetweenTheirBoxes) {
    for (int faces : {1, 4, 5, 6, 7, 8, 9, 100, 16'383, 16'384}) {
        Mesh mesh = torus(1.2f, 0.5f, 128, 64);
        mesh.triangles.resize(std::size_t(faces));
        const Tree tree(mesh);
        std::vector<char> found(mesh.triangles.size());
        for (Index face : tree.faces) found[face] = true;
        EXPECT_EQ(std::count(found.begin(), found.end(), true), faces);
        Index leaves = 0;
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const Tree::Node& node = tree.nodes[i];
            if (node.second == 0) {
                EXPECT_LE(node.count, 4u);
                ++leaves;
            } else {
                ASSERT_LT(node.second, tree.nodes.size());
                const Tree::Node &a = tree.nodes[i + 1], &b = tree.nodes[node.second];
                EXPECT_EQ(a.first, node.first);
                EXPECT_EQ(b.first, a.first + a.count);
                EXPECT_EQ(a.count + b.count, node.count);
            }
            Bounds box;
            for (Index f = node.first; f < node.first + node.count; ++f)
                for (int k = 0; k < 3; ++k) box.include(mesh.positions[mesh.triangles[tree.faces[f]][k]]);
            EXPECT_EQ(box.low, node.low);
            EXPECT_EQ(box.high, node.high);
        }
        EXPECT_EQ(tree.nodes.size(), 2 * leaves - 1);
    }
    EXPECT_TRUE(Tree(Mesh{}).nodes.empty());
}

TEST(Tree, IsTheSameByAnyNumberOfThreads) {
    const Mesh mesh = torus(1.2f, 0.5f, 300, 201);
    const Tree by_many(mesh);
    const Processors one(1);
    const Tree by_one(mesh);
    EXPECT_EQ(by_many.faces, by_one.faces);
    ASSERT_EQ(by_many.nodes.size(), by_one.nodes.size());
    for (std::size_t i = 0; i < by_one.nodes.size(); ++i) {
        EXPECT_EQ(by_many.nodes[i].low, by_one.nodes[i].low);
        EXPECT_EQ(by_many.nodes[i].high, by_one.nodes[i].high);
    }
}

}  // namespace
}  // namespace palpate
