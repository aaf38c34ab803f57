#include "palpate/mesh/solid.h"

#include "palpate/mesh/repair.h"
#include "tests/mesh/shapes.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

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

// Wherever a wall lies among the voxels, both of its sides are found.
TEST(SignedDistance, OfPlatesBetweenTheVoxels) {
    for (int place = 0; place <= 40; ++place) {
        const float half = 2 + 0.025f * float(place);  // voxels
        const SignedDistance distance(box(vec3(-8, -half, -8), vec3(8, half, 8)), 1);
        for (float y = -half - 1.5f; y < half + 1.5f; y += 0.25f)
            if (std::abs(y) > 1)
                ASSERT_LE(std::abs(distance.sample({0.3f, y, -0.4f}, 1, ivec3(1))[0] - (std::abs(y) - half)),
                          1e-4f)
                    << half << ' ' << y;
    }
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
            expect_refused("close its holes", [&] { SignedDistance(bowl, voxel); });
        }
    Mesh sheet{{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (float voxel : {0.03f, 0.1f})
        expect_refused("close its holes", [&] { SignedDistance(sheet, voxel); });
    expect_refused("nothing inside", [&] { SignedDistance(Mesh{}, 1); });
}

TEST(SignedDistance, TooFineAGridIsAnErrorBeforeItIsBuilt) {
    for (float voxel : {1e-4f, 1e-9f, 1e-38f})
        expect_refused("larger voxels", [&] { SignedDistance(box(vec3(0), vec3(1)), voxel); });
}

}  // namespace
}  // namespace palpate
