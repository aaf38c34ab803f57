#include "palpate/mesh/remake.h"

#include "palpate/mesh/repair.h"
#include "palpate/mesh/soundness.h"
#include "tests/mesh/shapes.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

constexpr double ball_volume = 4.0 / 3 * M_PI;

void expect_solid(const Mesh& mesh, double expected, double tolerance) {
    EXPECT_TRUE(soundness(mesh).closed());
    EXPECT_TRUE(std::abs(volume(mesh) / expected - 1) <= tolerance) << volume(mesh) << " for " << expected;
}

// What a line from an axis to an axis sweeps when it turns around z: out along one, back along the other.
// Points are (distance from the axis, height).
Mesh lathe(std::vector<vec2> line, const std::vector<vec2>& back) {
    line.insert(line.end(), back.begin(), back.end());
    constexpr unsigned around = 48;
    const auto points = unsigned(line.size());
    Mesh mesh;
    for (unsigned a = 0; a < around; ++a)
        for (vec2 p : line) {
            const float turn = 2 * float(M_PI) * float(a) / around;
            mesh.positions.push_back({p.x * std::cos(turn), p.x * std::sin(turn), p.y});
        }
    for (unsigned a = 0; a < around; ++a)
        for (unsigned i = 0; i < points; ++i) {
            const unsigned here = a * points, there = (a + 1) % around * points, j = (i + 1) % points;
            mesh.triangles.push_back({here + i, here + j, there + j});
            mesh.triangles.push_back({here + i, there + j, there + i});
        }
    weld(mesh);
    drop_collapsed(mesh);
    return volume(mesh) < 0 ? inside_out(mesh) : mesh;
}

std::string refusal(const Mesh& mesh, float voxel = 0) {
    const std::string said = palpate::refusal([&] { remake(mesh, voxel, "FILE"); });
    EXPECT_NE(said.find("FILE"), said.npos) << said;
    return said;
}

TEST(Remake, IsTrueToTheSurface) {
    const Mesh ball = sphere(vec3(0.3f, -2, 5), 1, 6);
    for (float voxel : {0.1f, 0.04f, 0.0173f}) {
        const Mesh made = remake(ball, voxel).solid;
        expect_solid(made, ball_volume, 0.003 + 1.2 * double(voxel * voxel));
        for (vec3 p : made.positions)
            ASSERT_TRUE(std::abs(glm::distance(p, vec3(0.3f, -2, 5)) - 1) <= 0.25f * voxel + 0.001f);
    }
}

TEST(Remake, TheUnionOfWhatOverlaps) {
    // Two unit balls whose middles are 1 apart share 5 pi / 12.
    const Mesh two = both(sphere(vec3(0), 1, 5), sphere(vec3(1, 0, 0), 1, 5));
    const Mesh made = remake(two, 0.03f).solid;
    expect_solid(made, 2 * ball_volume - 5 * M_PI / 12, 0.01);
    EXPECT_EQ(soundness(made).parts, 1u);
}

TEST(Remake, ClosesSmallHolesAndLarge) {
    const Mesh whole = sphere(vec3(0), 1, 5);
    for (float cut : {0.95f, 0.5f}) {
        Mesh open = whole;
        std::erase_if(open.triangles, [&](uvec3 t) { return open.positions[t.x].z > cut; });
        const double cap = M_PI * (1 - cut) * (1 - cut) * (2 + cut) / 3;
        const Mesh made = remake(open, 0.03f).solid;
        expect_solid(made, ball_volume - cap / 2, 0.5 * cap / ball_volume + 0.01);  // somewhere over the hole
        EXPECT_EQ(soundness(made).parts, 1u);
    }
}

TEST(Remake, KeepsCavitiesAndMergesShells) {
    const Mesh ball = sphere(vec3(0), 1, 5), core = sphere(vec3(0), 0.5f, 5);
    expect_solid(remake(both(ball, inside_out(core)), 0.04f).solid, ball_volume * 7 / 8, 0.01);
    expect_solid(remake(both(ball, core), 0.04f).solid, ball_volume, 0.01);
}

// A box with walls 0.2 thick, of six plates that overlap at its edges.
Mesh plates() {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float at : {0.0f, 0.8f}) {
            vec3 low(0), high(1);
            low[axis] = at, high[axis] = at + 0.2f;
            mesh = both(mesh, box(low, high));
        }
    return mesh;
}

TEST(Remake, AHollowThatNoWallBoundsIsFilled) {
    const Remade made = remake(plates(), 0.03f);
    expect_solid(made.solid, 1, 0.02);
    EXPECT_EQ(soundness(made.solid).parts, 1u);
    EXPECT_EQ(made.hollows.parts, 1u);
    EXPECT_TRUE(std::abs(made.hollows.volume / 0.216 - 1) <= 0.05) << made.hollows.volume;
    EXPECT_EQ(made.bits.parts, 0u);
    EXPECT_EQ(made.thin_faces, 0u);
}

TEST(Remake, AnInnerWallKeepsTheHollow) {
    // Also where it is open, and where something stands in it.
    Mesh inner = inside_out(sphere(vec3(0.5f), 0.28f, 4));
    const double cavity = -volume(inner);
    std::erase_if(inner.triangles, [&](uvec3 t) { return inner.positions[t.x].z > 0.76f; });
    Mesh mesh = both(both(box(vec3(0), vec3(1)), inner), sphere({0.5f, 0.5f, 0.25f}, 0.1f, 3));
    const Remade made = remake(mesh, 0.02f);
    EXPECT_EQ(made.hollows.parts, 0u);
    EXPECT_EQ(soundness(made.solid).parts, 2u);
    EXPECT_TRUE(volume(made.solid) < 1 - 0.9 * cavity) << volume(made.solid);
    EXPECT_TRUE(volume(made.solid) > 1 - cavity);
}

TEST(Remake, ABottleThatVoxelsCloseStaysHollow) {
    // A tube of 0.01 leads from the chamber to the outside, through a single wall.
    Mesh mesh = lathe({{0.01f, 1}, {1, 1}, {1, -1}, {0, -1}},
                      {{0, -0.8f}, {0.8f, -0.8f}, {0.8f, 0.8f}, {0.01f, 0.8f}});
    const double whole = 2 * M_PI, chamber = 1.6 * M_PI * 0.64;
    const Remade made = remake(mesh, 0.04f);
    EXPECT_EQ(made.hollows.parts, 0u);
    EXPECT_EQ(soundness(made.solid).parts, 2u);
    expect_solid(made.solid, whole - chamber, 0.03);
}

TEST(Remake, WallsThinnerThanAVoxelAreSaid) {
    // A fin of 1 by 1 on a cube: 2 of 8 in area, but for its edges.
    const Mesh mesh = both(box(vec3(0), vec3(1)), box({1, 0, 0.495f}, {2, 1, 0.505f}));
    const Remade made = remake(mesh, 0.05f);
    expect_solid(made.solid, 1, 0.05);
    EXPECT_GE(made.thin_faces, 4u);
    EXPECT_TRUE(std::abs(made.thin - 0.25) <= 0.03) << made.thin;
    EXPECT_EQ(remake(mesh, 0.004f).thin_faces, 0u);
}

TEST(Remake, ManyHolesEverywhere) {
    Mesh mesh = torus(2, 0.7f, 120, 60);
    const double expected = volume(mesh);
    std::mt19937 random(5);
    std::erase_if(mesh.triangles, [&](uvec3) { return random() % 8 == 0; });
    const Mesh made = remake(mesh, 0.04f).solid;
    expect_solid(made, expected, 0.02);
    EXPECT_EQ(soundness(made).euler, 0);
}

TEST(Remake, SizeAndPlaceDoNotMatter) {
    for (float scale : {1e-20f, 1e-3f, 1e3f, 1e30f}) {
        Mesh mesh = sphere(vec3(0.5f), 1, 4);
        for (vec3& p : mesh.positions) p *= scale;
        const Mesh made = remake(mesh, 0.05f * scale).solid;
        const double unit = double(scale) * double(scale) * double(scale);
        expect_solid(made, volume(mesh), 0.01);
        EXPECT_TRUE(volume(made) / unit > 4);
    }
}

TEST(Remake, WhatHasNoInsideIsAnError) {
    const Mesh sheet{
        {vec3(0), vec3(1, 0, 0), vec3(1, 1, 0.2f), vec3(0, 1, 0.2f)}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (const Mesh& mesh : {sheet, Mesh{}, Mesh{{vec3(1)}, {}, {{0, 0, 0}}},
                             Mesh{{vec3(0), vec3(1), vec3(2)}, {}, {{0, 1, 2}}}})
        EXPECT_NE(refusal(mesh).find("give it a thickness"), std::string::npos) << refusal(mesh);
}

TEST(Remake, TooFineAGridIsAnErrorBeforeItIsBuilt) {
    for (float voxel : {1e-4f, 1e-9f, 1e-38f})
        EXPECT_NE(refusal(box(vec3(0), vec3(1)), voxel).find("larger voxels"), std::string::npos);
}

}  // namespace
}  // namespace palpate
