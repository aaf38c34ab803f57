// The pressure of a tip on a surface, and what a tactile sensor measures of it.
#include "palpate/body/pressure_map.h"

#include "palpate/mesh/mesh.h"
#include "tests/refusal.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double pi = 3.14159265358979;

// A plane at z = 0 around the origin, of triangles of a side of 0.5 mm.
Mesh plane() { return block(vec3(-0.02f, -0.02f, -0.01f), vec3(0.02f, 0.02f, 0), 80); }

const Press ball{.centre = vec3(0.001f, -0.002f, 0.008f), .radius = 0.01f, .stiffness = 400};  // 2 mm deep

dvec3 sum_of(const std::vector<PressedVertex>& pressed) {
    dvec3 sum(0);
    for (const PressedVertex& one : pressed) sum += one.force;
    return sum;
}

TEST(PressureMap, OfABallInAPlaneIsThatOfItsDepth) {
    const Mesh surface = plane();
    const double radius = 0.01, depth = 0.002,
                 force = 400 * depth * depth * (radius - depth) / (radius * radius);
    const auto pressed = pressed_vertices(surface.positions, surface.triangles, ball, {0, 0, -force});
    double area = 0;
    for (const PressedVertex& one : pressed) {
        const double distance = glm::distance(dvec3(surface.positions[one.vertex]), dvec3(ball.centre));
        const double law = (radius - distance) * 400 / (pi * radius * radius);
        EXPECT_LE(std::abs(one.pressure - law), 0.01 * 400 * depth / (pi * radius * radius)) << one.vertex;
        area += one.area;
    }
    EXPECT_LE(glm::distance(sum_of(pressed), {0, 0, -force}), 0.01 * force);
    EXPECT_LE(std::abs(area / (pi * depth * (2 * radius - depth)) - 1), 0.05);
}

// Whatever force a body was pressed with: along it, all vertices give just that.
TEST(PressureMap, AddsUpToTheForce) {
    const Mesh surface = ellipsoid({0.03f, 0.02f, 0.025f}, 40);
    const Press press{.centre = 1.25f * vec3(0.02f, 0.015f, 0.01f), .radius = 0.012f, .stiffness = 300};
    const dvec3 force(-0.3, -0.2, -0.05);
    const auto pressed = pressed_vertices(surface.positions, surface.triangles, press, force);
    ASSERT_GT(pressed.size(), 10u);
    EXPECT_LE(std::abs(glm::dot(sum_of(pressed), glm::normalize(force)) - glm::length(force)), 1e-12);
}

TEST(PressureMap, IsEmptyWhereNothingIsPressed) {
    const Mesh surface = plane();
    EXPECT_TRUE(
        pressed_vertices(surface.positions, surface.triangles, {.centre = vec3(1)}, {0, 0, -1}).empty());
    EXPECT_TRUE(pressed_vertices(surface.positions, surface.triangles, ball, dvec3(0)).empty());
    const Mesh coarse = block(vec3(-1), vec3(1, 1, 0), 1);
    EXPECT_TRUE(pressed_vertices(coarse.positions, coarse.triangles, ball, {0, 0, -1}).empty());
}

TEST(PressureMap, RefusesWhatIsNotFinite) {
    Mesh surface = plane();
    Press wrong = ball;
    wrong.radius = std::numeric_limits<float>::quiet_NaN();
    auto of = [&](const Press& press, dvec3 force) {
        pressed_vertices(surface.positions, surface.triangles, press, force);
    };
    expect_refused("not finite", [&] { of(wrong, {0, 0, -1}); });
    expect_refused("not finite", [&] { of(ball, dvec3(std::nan(""))); });
    surface.positions[5].x = std::numeric_limits<float>::infinity();
    expect_refused("not finite", [&] { of(ball, {0, 0, -1}); });
    surface = plane();
    surface.triangles[7].y = 1'000'000;
    expect_refused("a vertex that there is not", [&] { of(ball, {0, 0, -1}); });
}

class Taxels : public ::testing::Test {
 protected:
    const Mesh surface_ = plane();
    const double force_ = 0.5;
    const std::vector<PressedVertex> pressed_ =
        pressed_vertices(surface_.positions, surface_.triangles, ball, {0, 0, -force_});

    std::vector<double> of(const Pad& pad) const { return taxels(pad, surface_.positions, pressed_); }
};

// A pad that covers the contact: the force, wherever its taxels' borders are, and from either side.
TEST_F(Taxels, AddUpToTheForceAlongTheNormal) {
    for (int count : {1, 3, 8})
        for (float side : {0.016f, 0.03f})
            for (int sign : {1, -1}) {
                const Pad pad{{0.001f, -0.0015f, 0.5f},
                              {side, 0, 0},
                              {0.002f, float(sign) * side, 0},
                              count,
                              count + 1};
                double sum = 0;
                for (double one : of(pad)) sum += one;
                const double area = double(side) * double(side) / (count * (count + 1));
                EXPECT_LE(std::abs(sum * area - force_), 1e-6 * force_) << count << " " << side;
            }
    // Turned by 60 degrees it measures half.
    const float half = 0.5f, most = std::sqrt(0.75f);
    const Pad turned{{0, 0, 0}, {0.04f, 0, 0}, {0, half * 0.08f, most * 0.08f}, 1, 1};
    EXPECT_LE(std::abs(of(turned)[0] * 0.04 * 0.08 - force_ / 2), 0.01 * force_);
}

// The ball is in the third column of the second row alone.
TEST_F(Taxels, AreRowByRow) {
    const std::vector<double> all = of({{0.001f - 0.0075f, -0.002f, 0}, {0.06f, 0, 0}, {0, 0.045f, 0}, 4, 3});
    ASSERT_EQ(all.size(), 12u);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (i == 6)
            EXPECT_LE(std::abs(all[i] / (force_ / (0.015 * 0.015)) - 1), 0.01);
        else
            EXPECT_EQ(all[i], 0) << i;
}

// The border between two taxels runs through vertices; either gets its half of them.
TEST_F(Taxels, ShareWhatLiesBetweenThem) {
    const std::vector<double> four = of({ball.centre, {0.02f, 0, 0}, {0, 0.02f, 0}, 2, 2});
    for (double one : four) EXPECT_LE(std::abs(one / (force_ / (0.02 * 0.02)) - 1), 1e-4);
}

TEST_F(Taxels, ArePartOfWhatAPadCovers) {
    const std::vector<double> half = of({{0.001f + 0.02f, -0.002f, 0}, {0.04f, 0, 0}, {0, 0.04f, 0}, 1, 1});
    EXPECT_LE(std::abs(half[0] * 0.04 * 0.04 - force_ / 2), 1e-4 * force_);
}

TEST_F(Taxels, AreRefusedWithoutAPad) {
    expect_refused("sides that are parallel", [&] { of({{}, {0.01f, 0, 0}, {0.02f, 0, 0}}); });
    expect_refused("sides that are parallel", [&] { of({{}, {0.01f, 0, 0}, {0, std::nanf(""), 0}}); });
    expect_refused("no taxels", [&] { of({{}, {0.01f, 0, 0}, {0, 0.01f, 0}, 0, 4}); });
    expect_refused("more than 10,000", [&] { of({{}, {0.01f, 0, 0}, {0, 0.01f, 0}, 1000, 1000}); });
    expect_refused("of 3", [&] {
        taxels({{}, {1, 0, 0}, {0, 1, 0}}, std::span(surface_.positions).first(3), pressed_);
    });
}

}  // namespace
}  // namespace palpate
