// What make_surface() makes of one recipe.
#include "palpate/scene/surface.h"

#include "palpate/mesh/write.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

float longest_side(const Mesh& mesh) {
    const vec3 size = bounds(mesh).size();
    return std::max({size.x, size.y, size.z});
}

TEST(Surface, IsScaledToItsSizeAndCentred) {
    Scratch scratch;
    BodyRecipe recipe;
    recipe.surface = "ball.ply";
    recipe.size = 0.2f;
    recipe.centre = true;
    recipe.move = {1, 2, 3};
    for (const float radius : {0.004f, 3.0f, 700.0f}) {
        write_mesh(ellipsoid(vec3(radius), 12), scratch / "ball.ply");
        const Mesh made = make_surface(recipe, scratch / "").mesh;
        EXPECT_NEAR(longest_side(made), 0.2f, 1e-6f);
        EXPECT_LT(glm::distance(bounds(made).centre(), vec3(1, 2, 3)), 1e-6f);
    }
}

TEST(Surface, LengthsForItsMendingCountAfterScaling) {
    Scratch scratch;
    BodyRecipe recipe;
    recipe.surface = "ball.ply";
    recipe.size = 0.2f;
    recipe.repair.solid = SolidBy::voxels;
    recipe.repair.voxel = 0.02f;
    std::vector<std::size_t> faces;
    for (const float radius : {0.1f, 50.0f}) {
        write_mesh(ellipsoid(vec3(radius), 40), scratch / "ball.ply");
        faces.push_back(make_surface(recipe, scratch / "").mesh.triangles.size());
    }
    EXPECT_EQ(faces[0], faces[1]);
    EXPECT_GT(faces[0], 400u);  // ten voxels across
    EXPECT_LT(faces[0], 1200u);
}

}  // namespace
}  // namespace palpate
