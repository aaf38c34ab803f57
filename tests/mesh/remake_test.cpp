#include "palpate/mesh/remake.h"

#include "palpate/base/error.h"
#include "palpate/mesh/soundness.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

constexpr double ball_volume = 4.0 / 3 * M_PI;

void expect_solid(const Mesh& mesh, double expected, double tolerance) {
    EXPECT_TRUE(soundness(mesh).closed());
    EXPECT_TRUE(std::abs(volume(mesh) / expected - 1) <= tolerance) << volume(mesh) << " for " << expected;
}

std::string error_of(const Mesh& mesh, float voxel = 0) {
    try {
        remake(mesh, voxel, "FILE");
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("FILE"), std::string::npos);
        return error.what();
    }
    return "no error";
}

TEST(Remake, IsTrueToTheSurface) {
    const Mesh ball = sphere(vec3(0.3f, -2, 5), 1, 6);
    for (float voxel : {0.1f, 0.04f, 0.0173f}) {
        const Mesh made = remake(ball, voxel);
        expect_solid(made, ball_volume, 0.003 + 1.2 * double(voxel * voxel));
        for (vec3 p : made.positions)
            ASSERT_TRUE(std::abs(glm::distance(p, vec3(0.3f, -2, 5)) - 1) <= 0.25f * voxel + 0.001f);
    }
}

TEST(Remake, TheUnionOfWhatOverlaps) {
    // Two unit balls whose middles are 1 apart share 5 pi / 12.
    const Mesh two = both(sphere(vec3(0), 1, 5), sphere(vec3(1, 0, 0), 1, 5));
    const Mesh made = remake(two, 0.03f);
    expect_solid(made, 2 * ball_volume - 5 * M_PI / 12, 0.01);
    EXPECT_EQ(soundness(made).parts, 1u);
}

TEST(Remake, ClosesSmallHolesAndLarge) {
    const Mesh whole = sphere(vec3(0), 1, 5);
    for (float cut : {0.95f, 0.5f}) {
        Mesh open = whole;
        std::erase_if(open.triangles, [&](uvec3 t) { return open.positions[t.x].z > cut; });
        const double cap = M_PI * (1 - cut) * (1 - cut) * (2 + cut) / 3;
        const Mesh made = remake(open, 0.03f);
        expect_solid(made, ball_volume - cap / 2, 0.5 * cap / ball_volume + 0.01);  // somewhere over the hole
        EXPECT_EQ(soundness(made).parts, 1u);
    }
}

TEST(Remake, KeepsCavitiesAndMergesShells) {
    const Mesh ball = sphere(vec3(0), 1, 5), core = sphere(vec3(0), 0.5f, 5);
    expect_solid(remake(both(ball, inside_out(core)), 0.04f), ball_volume * 7 / 8, 0.01);
    expect_solid(remake(both(ball, core), 0.04f), ball_volume, 0.01);
}

TEST(Remake, ManyHolesEverywhere) {
    Mesh mesh = torus(2, 0.7f, 120, 60);
    const double expected = volume(mesh);
    std::mt19937 random(5);
    std::erase_if(mesh.triangles, [&](uvec3) { return random() % 8 == 0; });
    const Mesh made = remake(mesh, 0.04f);
    expect_solid(made, expected, 0.02);
    EXPECT_EQ(soundness(made).euler, 0);
}

TEST(Remake, SizeAndPlaceDoNotMatter) {
    for (float scale : {1e-20f, 1e-3f, 1e3f, 1e30f}) {
        Mesh mesh = sphere(vec3(0.5f), 1, 4);
        for (vec3& p : mesh.positions) p *= scale;
        const Mesh made = remake(mesh, 0.05f * scale);
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
        EXPECT_NE(error_of(mesh).find("give it a thickness"), std::string::npos) << error_of(mesh);
}

TEST(Remake, TooFineAGridIsAnErrorBeforeItIsBuilt) {
    for (float voxel : {1e-4f, 1e-9f, 1e-38f})
        EXPECT_NE(error_of(box(vec3(0), vec3(1)), voxel).find("larger voxels"), std::string::npos);
}

}  // namespace
}  // namespace palpate
