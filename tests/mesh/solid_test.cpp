#include "palpate/mesh/solid.h"

#include "palpate/base/error.h"
#include "palpate/mesh/repair.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

void expect_closed(const Mesh& mesh) {
    const Soundness found = soundness(mesh);
    EXPECT_EQ(found.open_edges, 0u);
    EXPECT_EQ(found.bad_edges, 0u);
    EXPECT_GT(volume(mesh), 0);
}

template <class F>
std::string error_of(F f) {
    try {
        f();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "no error";
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
        expect_closed(mesh);
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
        expect_closed(mesh);  // a reflection would turn it inside out
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
        expect_closed(mesh);
        EXPECT_LE(std::abs(bounds(mesh).low.x + 0.5f), 0.5f) << "no farther out than the next voxel would be";
        EXPECT_LE(volume(mesh) / (n * n * (n + 1)), 1);
        EXPECT_GE(volume(mesh) / (n * n * (n + 1)), n > 2 ? 0.7 : 0.015);
    }
}

TEST(Isosurface, OfRubbleIsClosed) {
    for (unsigned seed = 0; seed < 30; ++seed) {
        const ivec3 dims(3 + seed * 7 % 23, 3 + seed * 5 % 19, 3 + seed * 3 % 17);
        expect_closed(isosurface(rubble(dims, seed), 0.25f + 0.02f * float(seed % 26)));
    }
}

TEST(Isosurface, TakesAnyRangeOfValues) {
    for (float scale : {1e-30f, 1.0f, 1e38f}) {
        Volume v = ball(ivec3(16), 5);
        for (float& value : v.values) value *= scale * 0.1f;
        const Mesh mesh = isosurface(v, 1e-5f * scale);
        expect_closed(mesh);
        EXPECT_LE(std::abs(volume(mesh) / (4.0 / 3 * M_PI * 125) - 1), 0.07);
    }
}

TEST(Isosurface, OutsideTheRangeIsAnErrorThatNamesIt) {
    const Volume v = volume_of(ivec3(3), [](vec3 p) { return p.x; });
    for (float iso : {-1.0f, 0.0f, 2.0f, 99.0f, NAN, INFINITY})
        EXPECT_NE(error_of([&] { isosurface(v, iso); }).find("0 to 2"), std::string::npos) << iso;
}

TEST(SignedDistance, OfABall) {
    const vec3 centre(0.2f, 0.3f, -0.1f);
    for (float voxel : {0.002f, 0.005f}) {
        const SignedDistance distance(sphere(centre, 0.05f, 6), voxel);
        const ivec3 dims(41, 35, 38);
        const float h = 0.0035f;
        const vec3 origin = centre - 0.5f * h * vec3(dims);
        const std::vector<float> sampled = distance.sample(origin, h, dims);
        ASSERT_EQ(sampled.size(), std::size_t(41 * 35 * 38));
        std::size_t i = 0;
        for (int z = 0; z < dims.z; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x, ++i) {
                    const float exact = glm::distance(origin + h * vec3(x, y, z), centre) - 0.05f;
                    if (std::abs(exact) < 2 * voxel)
                        ASSERT_LE(std::abs(sampled[i] - exact), 0.1f * voxel);
                    else
                        ASSERT_LE(std::abs(sampled[i] - glm::clamp(exact, -3 * voxel, 3 * voxel)),
                                  0.5f * voxel);
                }
    }
}

TEST(SignedDistance, OfABoxOnTheGrid) {
    const SignedDistance distance(box(vec3(0), vec3(0.08f, 0.04f, 0.02f)), 0.005f);
    EXPECT_LE(std::abs(distance.sample({0.04f, 0.02f, 0.025f}, 1, ivec3(1))[0] - 0.005f), 2e-4f);
    EXPECT_LE(std::abs(distance.sample({0.04f, 0.02f, 0.01f}, 1, ivec3(1))[0] + 0.010f), 3e-3f);
    EXPECT_LE(std::abs(distance.sample({0.04f, -1, 0.01f}, 1, ivec3(1))[0] - 0.015f), 1e-6f)
        << "three voxels off";
}

TEST(SignedDistance, InsideDoesNotDependOnHowFacesTurn) {
    const vec3 centre(0);
    EXPECT_LT(SignedDistance(inside_out(sphere(centre, 1, 4)), 0.1f).sample(centre, 1, ivec3(1))[0], 0);
}

TEST(SignedDistance, SmallHolesAndClosedCavitiesDoNotMatter) {
    Mesh leaky = sphere(vec3(0), 1, 5);
    leaky.triangles.pop_back();
    EXPECT_LT(SignedDistance(leaky, 0.1f).sample(vec3(0), 1, ivec3(1))[0], 0);
    const Mesh hollow = both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 4)));
    EXPECT_LT(SignedDistance(hollow, 0.05f).sample(vec3(0), 1, ivec3(1))[0], 0);
}

TEST(SignedDistance, OfAnOpenMeshIsAnError) {
    for (float voxel : {0.02f, 0.05f, 0.1f})
        for (float cut : {0.8f, 0.0f, -0.8f}) {
            Mesh bowl = sphere(vec3(0), 1, 5);
            std::erase_if(bowl.triangles, [&](uvec3 t) { return bowl.positions[t.x].z > cut; });
            EXPECT_NE(error_of([&] { SignedDistance(bowl, voxel); }).find("close its holes"),
                      std::string::npos);
        }
    Mesh sheet{{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (float voxel : {0.03f, 0.1f})
        EXPECT_NE(error_of([&] { SignedDistance(sheet, voxel); }).find("close its holes"), std::string::npos);
    EXPECT_NE(error_of([&] { SignedDistance(Mesh{}, 1); }).find("nothing inside"), std::string::npos);
}

TEST(SignedDistance, TooFineAGridIsAnErrorBeforeItIsBuilt) {
    for (float voxel : {1e-4f, 1e-9f, 1e-38f})
        EXPECT_NE(error_of([&] { SignedDistance(box(vec3(0), vec3(1)), voxel); }).find("larger voxels"),
                  std::string::npos);
}

}  // namespace
}  // namespace palpate
