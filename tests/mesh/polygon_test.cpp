#include "palpate/mesh/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>

namespace palpate {
namespace {

using Outline = std::vector<dvec2>;

// In a plane that faces nowhere in particular.
std::vector<vec3> tilted(const Outline& outline) {
    const dvec3 x = glm::normalize(dvec3(1, 2, -0.5)), y = glm::normalize(glm::cross(x, dvec3(0.3, 1, 2)));
    std::vector<vec3> corners;
    for (dvec2 p : outline) corners.emplace_back(x * p.x + y * p.y + dvec3(3, -2, 1));
    return corners;
}

std::vector<uvec3> cut(const std::vector<vec3>& corners) {
    std::vector<uvec3> triangles;
    triangulate(corners, triangles);
    return triangles;
}

// n - 2 triangles; each side of the polygon in one of them, every other edge once each way.
void expect_closed(const std::vector<uvec3>& triangles, std::size_t n) {
    ASSERT_EQ(triangles.size(), n - 2);
    std::map<std::pair<unsigned, unsigned>, int> edges;
    for (uvec3 t : triangles)
        for (int k = 0; k < 3; ++k) {
            ASSERT_LT(t[k], n);
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
    for (unsigned i = 0; i < n; ++i) {
        const auto side = edges.find({i, unsigned((i + 1) % n)});
        ASSERT_TRUE(side != edges.end()) << "no side " << i;
        --side->second;
    }
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        ASSERT_EQ(count, back == edges.end() ? 0 : back->second) << edge.first << ' ' << edge.second;
    }
}

double area(dvec2 a, dvec2 b, dvec2 c) {
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

// Triangles that all turn to the left and whose areas add up to the polygon's lie side by side in it.
void expect_tiling(const Outline& outline, const std::string& name) {
    const auto triangles = cut(tilted(outline));
    expect_closed(triangles, outline.size());
    double whole = 0, sum = 0, least = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
        whole += area({0, 0}, outline[i], outline[(i + 1) % outline.size()]);
    for (uvec3 t : triangles) {
        const double one = area(outline[t.x], outline[t.y], outline[t.z]);
        sum += one;
        least = std::min(least, one);
    }
    EXPECT_GT(whole, 0) << name;
    EXPECT_GE(least, -1e-5 * whole) << name;  // what the tilted floats have lost
    EXPECT_LE(std::abs(sum - whole), 1e-5 * whole) << name;
}

Outline circle(int n) {
    Outline outline;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        outline.push_back({std::cos(angle), std::sin(angle)});
    }
    return outline;
}

Outline star(int n, unsigned seed) {
    std::mt19937 random(seed);
    Outline outline = circle(n);
    for (dvec2& p : outline) p *= std::uniform_real_distribution(0.05, 1.0)(random);
    return outline;
}

// Thin teeth on a bar; every ear between them is long.
Outline comb(int teeth) {
    Outline outline = {{double(teeth), -0.1}};
    for (int i = teeth; i-- > 0;) {
        outline.push_back({i + 0.6, 1.0});
        outline.push_back({i + 0.4, 1.0 + 0.3 * std::sin(i)});
        outline.push_back({i + 0.0, 0.0});
    }
    outline.push_back({-0.5, -0.1});
    for (dvec2& p : outline) p.x /= teeth;
    return outline;
}

// A ribbon, wound up.
Outline spiral(int n, double turns) {
    Outline outline;
    auto at = [&](double way, double offset) {
        const double angle = 2 * std::numbers::pi * turns * way, r = 0.1 + way + offset / turns;
        outline.push_back({r * std::cos(angle), r * std::sin(angle)});
    };
    for (int i = 0; i < n / 2; ++i) at(2.0 * i / n, 0.4);
    for (int i = n / 2; i-- > 0;) at(2.0 * i / n, 0);
    return outline;
}

TEST(Polygon, TilesWhatIsConcave) {
    expect_tiling({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, "L");
    expect_tiling({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}}, "U");
    // A hole, cut open towards the rim: two sides lie on each other.
    expect_tiling({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}}, "hole");
    // Corners on the sides between others.
    expect_tiling({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}, "middles");
    for (int n : {5, 6, 7, 31, 100, 1001}) {
        expect_tiling(circle(n), "circle");
        expect_tiling(comb(n), "comb");
        expect_tiling(spiral(40 + 2 * n, 1 + n / 30), "spiral");
        for (unsigned seed = 0; seed < 20; ++seed) expect_tiling(star(n, seed), "star");
    }
}

TEST(Polygon, TilesTwoHundredThousandCorners) {  // in a second or so; n squared would take an hour
    const int n = 200'000;
    expect_tiling(circle(n), "circle");
    expect_tiling(star(n, 1), "star");
    expect_tiling(comb(n / 3), "comb");
    expect_tiling(spiral(n, 20), "spiral");
}

TEST(Polygon, MakesNoFanOfAConvexOne) {
    for (int n : {16, 100, 5000}) {
        std::vector<int> faces(std::size_t(n), 0);
        for (uvec3 t : cut(tilted(circle(n))))
            for (int k = 0; k < 3; ++k) ++faces[t[k]];
        EXPECT_LE(*std::max_element(faces.begin(), faces.end()), 2 * std::log2(n) + 2) << n;
    }
}

TEST(Polygon, CutsAQuadWhereItIsRight) {
    const std::vector<uvec3> first = {{0, 1, 2}, {0, 2, 3}}, other = {{1, 2, 3}, {1, 3, 0}};
    EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), first);
    EXPECT_EQ(cut({{0, 0, 0}, {3, 0, 0}, {4, 1, 0}, {1, 1, 0}}), other) << "the shorter diagonal";
    EXPECT_EQ(cut({{1, 1, 0}, {0, 0, 0}, {3, 0, 0}, {4, 1, 0}}), first);
    EXPECT_EQ(cut({{0.2f, 0.2f, 0}, {2, 0, 0}, {0, 0, 1e-3f}, {0, 2, 0}}), first) << "the other way round";
    // An arrowhead is cut at its concave corner, wherever the count begins and however it turns.
    std::vector<vec3> arrow = {{0, 0, 0}, {2, -1, 0}, {0.5f, 0, 0}, {2, 1, 0}};
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(cut(arrow), i % 2 == 0 ? first : other) << i;
        std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
    }
}

TEST(Polygon, LeavesNoGapInWhatHasNoShape) {
    std::mt19937 random(7);
    auto number = [&](double size) { return float(std::uniform_real_distribution(-size, size)(random)); };
    for (std::size_t n : {4, 5, 6, 17, 300, 5000}) {
        std::vector<vec3> wild(n), line(n), twice(n), back(n);
        for (std::size_t i = 0; i < n; ++i) {
            wild[i] = {number(1), number(1), number(1)};
            line[i] = float(i) * vec3(1, 2, 3);
            const double angle = 2 * std::numbers::pi * double(i / 2) / double((n + 1) / 2);
            twice[i] = {std::cos(angle), std::sin(angle), 0};
            back[i] = {float(std::min(i, n - i)), 0, 0};
        }
        for (const auto& corners : {wild, line, twice, back, std::vector<vec3>(n, vec3(1, 2, 3))})
            expect_closed(cut(corners), n);
        for (float size : {1e30f, 1e38f, 1e-20f, 1e-44f}) {
            for (vec3& p : wild) p = size * glm::clamp(p, -1.0f, 1.0f);
            expect_closed(cut(wild), n);
        }
    }
    std::vector<uvec3> none;
    for (std::size_t n : {0, 1, 2}) triangulate(std::vector<vec3>(n), none);
    EXPECT_TRUE(none.empty());
}

// Every corner of a convex polygon written twice still gives its whole area.
TEST(Polygon, TakesCornersThatRepeat) {
    Outline twice;
    for (dvec2 p : circle(50)) twice.insert(twice.end(), {p, p});
    expect_tiling(twice, "twice");
}

}  // namespace
}  // namespace palpate
