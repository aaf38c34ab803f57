#include "palpate/render/shapes.h"

#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Unit normals, which agree with the way the triangles turn.
void expect_sound(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_FALSE(mesh.triangles.empty());
    for (vec3 n : mesh.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5f);
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 face = glm::cross(b - a, c - a);
        EXPECT_GT(glm::dot(face, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]), 0);
    }
}

TEST(Shapes, ACapsuleIsSoFarFromItsMiddleLine) {
    const Capsule capsule{{0.1f, 0.2f, 0.3f}, {0.3f, 0.1f, 0.4f}, 0.05f};
    const Mesh mesh = shape_mesh({capsule});
    expect_sound(mesh);
    const vec3 along = capsule.to - capsule.from;
    for (vec3 p : mesh.positions) {
        const float part = std::clamp(glm::dot(p - capsule.from, along) / glm::dot(along, along), 0.0f, 1.0f);
        EXPECT_NEAR(glm::distance(p, capsule.from + part * along), capsule.radius, 1e-6f);
    }
    const float r = capsule.radius;
    EXPECT_NEAR(volume(mesh) / (pi * r * r * glm::length(along) + 4 * pi / 3 * r * r * r), 1, 0.01);
    // Without a length it is a ball.
    const Mesh ball = shape_mesh({Capsule{vec3(1), vec3(1), 0.1f}});
    expect_sound(ball);
    EXPECT_NEAR(volume(ball) / (4 * pi / 3 * 0.001f), 1, 0.01);
}

TEST(Shapes, ABoxHasItsSidesAndItsRounding) {
    Box box{.centre = vec3(1, 2, 3), .half = vec3(0.1f, 0.2f, 0.3f)};
    box.axes = {vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 0, 0)};
    const Mesh sharp = shape_mesh({box});
    expect_sound(sharp);
    EXPECT_NEAR(volume(sharp), 0.2 * 0.4 * 0.6, 1e-6);
    EXPECT_LT(glm::distance(bounds(sharp).high, vec3(1.3f, 2.1f, 3.2f)), 1e-6f);
    box.rounding = 0.05f;
    const Mesh round = shape_mesh({box});
    expect_sound(round);
    EXPECT_LT(glm::distance(bounds(round).high, vec3(1.35f, 2.15f, 3.25f)), 1e-6f);
    const float r = 0.05f, a = 0.2f, b = 0.4f, c = 0.6f;
    const float steiner =
        a * b * c + 2 * r * (a * b + b * c + c * a) + pi * r * r * (a + b + c) + 4 * pi / 3 * r * r * r;
    EXPECT_NEAR(volume(round) / steiner, 1, 0.002);
}

TEST(Shapes, APolygonIsItsTriangles) {
    const Mesh mesh = shape_mesh({Polygon{{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}}, 0.01f}});
    expect_sound(mesh);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.normals[0], vec3(0, 0, 1));
}

TEST(Shapes, AFieldShowsTheMeshItWasMadeOf) {
    const Mesh ball = ellipsoid(vec3(0.05f, 0.04f, 0.03f), 40);
    const Mesh mesh = shape_mesh({distance_field(ball, 0.002f)});
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_NEAR(volume(mesh) / volume(ball), 1, 0.02);
}

TEST(Shapes, PlanesAndSpheresAreDrawnOtherwise) {
    EXPECT_TRUE(shape_mesh({Plane{}}).triangles.empty());
    EXPECT_TRUE(shape_mesh({Sphere{}}).triangles.empty());
}

}  // namespace
}  // namespace palpate
