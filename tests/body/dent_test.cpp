// Dents: how deep they are, and which way the dented surface looks.
#include "palpate/body/dent.h"

#include "bench/studies.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace palpate {
namespace {

class Dents : public ::testing::Test {
 protected:
    double any(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    vec3 any_vector(double size) { return vec3(any(-size, size), any(-size, size), any(-size, size)); }
    vec3 any_direction() { return glm::normalize(any_vector(1) + vec3(1e-3f)); }

    std::vector<Dent> any_dents(int count, vec3 middle, const dvec3& along, const dvec3& across,
                                vec3 facing) {
        std::vector<Dent> dents;
        for (int i = 0; i < count; ++i)
            dents.push_back({middle + vec3(any(-0.03, 0.03) * along + any(-0.03, 0.03) * across),
                             float(any(-0.01, 0.02)), float(any(0.004, 0.02)), i % 2 ? facing : vec3(0)});
        return dents;
    }
    std::mt19937 random_{11};
};

// The definition, in double: where a place of that normal comes to.
dvec3 displaced(const std::vector<Dent>& dents, dvec3 place, dvec3 normal) {
    dvec3 sum(0);
    for (const Dent& dent : dents) {
        const double d = glm::distance(place, dvec3(dent.centre));
        sum += dent.depth * std::exp(-d * d / (2.0 * dent.width * dent.width)) *
               (dent.facing == vec3(0) ? normal : dvec3(dent.facing));
    }
    return place - sum;
}

// Two that are a right-handed system with the normal.
std::pair<dvec3, dvec3> axes_beside(dvec3 n) {
    const dvec3 along = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    return {along, glm::cross(n, along)};
}

double degrees_between(dvec3 a, dvec3 b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

TEST_F(Dents, AreGaussiansThatAddUp) {
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<Dent> dents =
            any_dents(trial % 9, any_vector(0.1), {1, 0, 0}, {0, 0, 1}, any_direction());
        const vec3 place = (dents.empty() ? vec3(0) : dents.front().centre) + any_vector(0.05),
                   normal = any_direction();
        const dvec3 there = displaced(dents, place, normal);
        const double deep = glm::dot(dvec3(place) - there, dvec3(normal));
        EXPECT_LE(std::abs(depth_at(dents, place, normal) - deep),
                  2e-6 * (largest_displacement(dents) + 1e-3));
        EXPECT_LE(glm::distance(dvec3(dented(dents, place, normal)), there), 3e-8);
        EXPECT_LE(glm::distance(dvec3(place), there), 1.0001 * largest_displacement(dents));
    }
}

// A wall of 2 mm, and one of folds as high and as narrow: pressed as deep as may be, 8 mm.
TEST_F(Dents, ThatFaceAWayPushNothingThroughItself) {
    const float width = 0.007f, depth = float(deepest_dent(width));
    auto turned_over = [&](const Mesh& mesh, bool one_way) {
        const Dent dent{vec3(0), depth, width, one_way ? vec3(0, 0, 1) : vec3(0)};
        std::vector<vec3> at;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            at.push_back(dented({&dent, 1}, mesh.positions[v], mesh.normals[v]));
        auto way = [](const std::vector<vec3>& p, uvec3 t) {
            return glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
        };
        int turned = 0;
        for (uvec3 t : mesh.triangles) turned += !(glm::dot(way(mesh.positions, t), way(at, t)) > 0);
        return turned;
    };
    Mesh folds = block(vec3(-0.03f, -0.03f, -0.004f), vec3(0.03f, 0.03f, -0.002f), 120);
    for (vec3& p : folds.positions) p.z += 0.002f * std::sin(1500 * p.x) * std::cos(1200 * p.y + 300 * p.x);
    compute_normals(folds);
    EXPECT_EQ(turned_over(folds, true), 0);
    EXPECT_GE(turned_over(folds, false), 100);  // as in the paper

    const Dent one_way[] = {{vec3(0), depth, width, vec3(0, 0, 1)}}, own[] = {{vec3(0), depth, width}};
    for (float x : {0.0f, 0.004f, 0.012f}) {
        const vec3 front(x, 0, 0), back(x, 0, -0.002f), out(0, 0, 1);
        EXPECT_GT(dented(one_way, front, out).z, dented(one_way, back, -out).z) << x;
        if (x == 0) EXPECT_LT(dented(own, front, out).z, dented(own, back, -out).z);
    }
}

// Of any motion of space they are exact, so on whatever surface.
TEST_F(Dents, NormalsOfOnesThatFaceAWayAreThoseOfFiniteDifferences) {
    double most = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const vec3 place = any_vector(0.2), normal = any_direction();
        std::vector<Dent> dents;
        for (int i = 0; i < 1 + trial % 4; ++i)
            dents.push_back({place + any_vector(0.015), float(any(-0.004, 0.004)), 0.01f, any_direction()});
        const auto [along, across] = axes_beside(normal);
        const double h = 1e-6;
        auto at = [&](dvec3 step) { return displaced(dents, dvec3(place) + step, normal); };
        const dvec3 there = glm::cross(at(h * along) - at(-h * along), at(h * across) - at(-h * across));
        const double off = degrees_between(dvec3(dented_normal(dents, place, normal)), there);
        if (!(off <= most)) most = off;
    }
    EXPECT_LE(most, 0.01);
}

TEST_F(Dents, NormalsOfADentedPlaneAreThoseOfFiniteDifferences) {
    double most = 0, steepest = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const vec3 middle = any_vector(0.2), normal = any_direction();
        const auto [along, across] = axes_beside(normal);
        const std::vector<Dent> dents = any_dents(1 + trial % 7, middle, along, across, normal);
        const vec3 place = middle + vec3(any(-0.04, 0.04) * along + any(-0.04, 0.04) * across);
        auto at = [&](dvec3 step) { return displaced(dents, dvec3(place) + step, normal); };
        const double h = 1e-6;
        const dvec3 there = glm::cross(at(h * along) - at(-h * along), at(h * across) - at(-h * across));
        const vec3 ours = dented_normal(dents, place, normal);
        EXPECT_LE(std::abs(glm::length(ours) - 1), 1e-6f);
        const double off = degrees_between(dvec3(ours), there);
        if (!(off <= most)) most = off;
        steepest = std::max(steepest, degrees_between(there, normal));
    }
    EXPECT_LE(most, 0.01);
    EXPECT_GE(steepest, 45);  // there was something to get right
}

// What is left out is the sphere's own curvature: places near each other grow nearer as they go in.
double off_on_a_sphere(double width_over_radius, double depth_over_width) {
    double most = 0;
    for (int i = 1; i <= 300; ++i) {
        const double along = 3.0 * i / 300,
                     half = 0.5 * width_over_radius * along;  // along the arc, in widths
        const double chord = width_over_radius > 0 ? 2 / width_over_radius * std::sin(half) : along;
        const double deep = depth_over_width * std::exp(-0.5 * chord * chord),
                     slope = deep * chord * std::cos(half);
        most = std::max(most, std::abs(std::atan(slope / (1 - width_over_radius * deep)) - std::atan(slope)));
    }
    return glm::degrees(most);
}

TEST_F(Dents, NormalsOfADentedSphereAreOffByItsCurvatureAlone) {
    for (double width : {0.0, 0.05, 0.1, 0.2, 0.5, 1.0})
        for (double depth : {0.1, 0.3, 1.0, 2.0}) {
            if (!(width * depth < 1)) continue;
            const studies::DentNormals off = studies::dent_normals(width, depth);
            EXPECT_LE(std::abs(off.ours - off_on_a_sphere(width, depth)), 0.01) << width << ", " << depth;
            if (width * depth <= 0.1) EXPECT_LE(off.ours, 3.0) << width << ", " << depth;
        }
}

// Each slip of the printed formulas matters by itself.
TEST_F(Dents, NormalsByThePrintedFormulasAreFarOff) {
    for (double width : {0.0, 0.1, 0.5}) {
        const studies::DentNormals off = studies::dent_normals(width, 1.0);
        EXPECT_GE(off.printed, 30) << width;
        EXPECT_GE(off.with_exponent, 20) << width;
        EXPECT_GE(off.with_axis, 60) << width;
    }
    EXPECT_LE(studies::dent_normals(0, 1.0).with_both, 0.01);
}

template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST_F(Dents, WithoutAnyNothingMoves) {
    const std::vector<Dent> far = {{vec3(5, 0, 0), 0.02f, 0.01f}, {vec3(0), 0, 0.01f}};
    for (int trial = 0; trial < 100; ++trial) {
        const vec3 place = any_vector(0.3), normal = any_direction();
        for (std::span<const Dent> none : {std::span<const Dent>(), std::span<const Dent>(far)}) {
            EXPECT_EQ(depth_at(none, place, normal), 0.0f);
            EXPECT_TRUE(same_bits(dented(none, place, normal), place));
            EXPECT_TRUE(same_bits(dented_normal(none, place, normal), normal));
        }
    }
}

TEST_F(Dents, OfNoSaneLengthsAreHarmless) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const float odd[] = {nan, infinity, -infinity, 3e38f, -3e38f, 0, -0.01f, 1e-38f, 1e-9f, 9e8f};
    for (float a : odd)
        for (float b : odd)
            for (const Dent& dent :
                 {Dent{vec3(a, 0, 0), b, 0.01f}, Dent{vec3(0), a, b}, Dent{vec3(0, b, 0), 0.01f, a},
                  Dent{vec3(0), 0.01f, 0.01f, vec3(a, b, 0)}}) {
                EXPECT_TRUE(std::isfinite(largest_displacement({&dent, 1})));
                for (vec3 place : {vec3(0), vec3(1e-9f, 0, 0), vec3(0.01f, 0.02f, -0.5f), vec3(1e6f)}) {
                    const vec3 normal = any_direction(), p = dented({&dent, 1}, place, normal),
                               n = dented_normal({&dent, 1}, place, normal);
                    EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << a << ", " << b;
                    EXPECT_LE(std::abs(glm::length(n) - 1), 1e-5f) << a << ", " << b;
                    if (!acts(dent)) EXPECT_TRUE(same_bits(p, place) && same_bits(n, normal));
                }
            }
    for (float a : {nan, infinity, 0.0f, -0.01f}) EXPECT_FALSE(acts({vec3(0), 0.01f, a})) << a;
    for (float a : {nan, infinity, 0.0f}) EXPECT_FALSE(acts({vec3(0), a})) << a;
    EXPECT_TRUE(acts({vec3(0), -0.01f}));
}

}  // namespace
}  // namespace palpate
