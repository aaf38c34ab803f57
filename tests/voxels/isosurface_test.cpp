#include "palpate/voxels/isosurface.h"

#include "palpate/mesh/repair.h"
#include "tests/mesh/shapes.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

void expect_solid(const Mesh& mesh) {
    expect_closed(mesh);
    EXPECT_GT(volume(mesh), 0);
}

// How far inside a ball of this radius about the volume's middle each voxel lies.
Volume ball(ivec3 dims, float radius) {
    const vec3 centre = vec3(dims - 1) * 0.5f;
    return volume_of(dims, [=](vec3 p) { return radius - glm::distance(p, centre); });
}

TEST(Isosurface, OfABall) {
    struct {
        int size;
        double volume, area, distance;  // allowed: relative, relative, voxels
    } cases[] = {{16, 0.05, 0.03, 0.08}, {33, 0.012, 0.008, 0.04}, {64, 0.004, 0.002, 0.02}};
    for (auto c : cases) {
        const double r = 0.35 * c.size;
        const Mesh mesh = isosurface(ball(ivec3(c.size), float(r)), 1e-4f);
        expect_solid(mesh);
        EXPECT_EQ(soundness(mesh).parts, 1u);
        EXPECT_LE(std::abs(volume(mesh) / (4.0 / 3 * M_PI * r * r * r) - 1), c.volume);
        EXPECT_LE(std::abs(area(mesh) / (4 * M_PI * r * r) - 1), c.area);
        for (vec3 p : mesh.positions)
            ASSERT_LE(std::abs(glm::distance(p, vec3((c.size - 1) * 0.5f)) - r), c.distance);
    }
}

TEST(Isosurface, LiesWhereTheVolumeLies) {
    Volume v = ball({31, 27, 35}, 10);
    v.spacing = vec3(0.001f, 0.002f, 0.0015f);
    v.origin = vec3(0.5f, -0.25f, 0.125f);
    const double ellipsoid = 4.0 / 3 * M_PI * 1000 * 0.001 * 0.002 * 0.0015;
    const mat3 turned =
        mat3(0.6f, 0.8f, 0, -0.8f, 0.6f, 0, 0, 0, 1) * mat3(1, 0, 0, 0, 0.28f, 0.96f, 0, -0.96f, 0.28f);
    for (mat3 direction : {mat3(1), turned, turned * mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), mat3(-1)}) {
        v.direction = direction;
        const Mesh mesh = isosurface(v, 1e-4f);
        expect_solid(mesh);  // a reflection would turn it inside out
        EXPECT_LE(std::abs(volume(mesh) / ellipsoid - 1), 0.02);
        const vec3 centre = v.origin + v.direction * (v.spacing * vec3(15, 13, 17));
        EXPECT_LE(glm::distance(bounds(mesh).centre(), centre), 1e-5f);
    }
}

TEST(Isosurface, IsClosedWhereTheVolumeIsCut) {
    for (int n : {1, 2, 3, 7, 8, 9, 16, 17}) {  // OpenVDB's blocks are 8 wide
        Volume full = volume_of(ivec3(n, n, n + 1), [](vec3) { return 1.0f; });
        full.values[0] = 0;
        const Mesh mesh = isosurface(full, 0.5f);
        expect_solid(mesh);
        EXPECT_LE(std::abs(bounds(mesh).low.x + 0.5f), 0.5f) << "no farther out than the next voxel would be";
        EXPECT_LE(volume(mesh) / (n * n * (n + 1)), 1);
        EXPECT_GE(volume(mesh) / (n * n * (n + 1)), n > 2 ? 0.7 : 0.015);
    }
}

TEST(Isosurface, OfRubbleIsClosed) {
    for (unsigned seed = 0; seed < 30; ++seed) {
        const ivec3 dims(3 + seed * 7 % 23, 3 + seed * 5 % 19, 3 + seed * 3 % 17);
        expect_solid(isosurface(rubble(dims, seed), 0.25f + 0.02f * float(seed % 26)));
    }
}

TEST(Isosurface, TakesAnyRangeOfValues) {
    for (float scale : {1e-30f, 1.0f, 1e38f}) {
        Volume v = ball(ivec3(16), 5);
        for (float& value : v.values) value *= scale * 0.1f;
        const Mesh mesh = isosurface(v, 1e-5f * scale);
        expect_solid(mesh);
        EXPECT_LE(std::abs(volume(mesh) / (4.0 / 3 * M_PI * 125) - 1), 0.07);
    }
}

TEST(Isosurface, OutsideTheRangeIsAnErrorThatNamesIt) {
    const Volume v = volume_of(ivec3(3), [](vec3 p) { return p.x; });
    for (float iso : {-1.0f, 0.0f, 2.0f, 99.0f, NAN, INFINITY}) {
        SCOPED_TRACE(iso);
        expect_refused("0 to 2", [&] { isosurface(v, iso); });
    }
}

}  // namespace
}  // namespace palpate
