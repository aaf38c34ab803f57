#include "palpate/mesh/mesh.h"

#include "palpate/mesh/triangle.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace palpate {
namespace {

TEST(Mesh, UnitsAreMetres) {
    EXPECT_EQ(metres(Units::metres), 1.0f);
    EXPECT_EQ(metres(Units::centimetres), 0.01f);
    EXPECT_EQ(metres(Units::millimetres), 0.001f);
    EXPECT_EQ(metres(Units::micrometres), 1e-6f);
}

TEST(Mesh, BoundsHoldAllVertices) {
    EXPECT_TRUE(bounds(Mesh{}).empty());
    const Bounds b = bounds(box({-1, 2, 3}, {4, 5, 7}));
    EXPECT_EQ(b.low, vec3(-1, 2, 3));
    EXPECT_EQ(b.high, vec3(4, 5, 7));
}

TEST(Mesh, VolumeOfABox) {
    EXPECT_EQ(volume(Mesh{}), 0);
    EXPECT_LE(std::abs(volume(box({-1, 2, 3}, {1, 5, 7})) - 24), 1e-12);
    EXPECT_LE(std::abs(volume(inside_out(box({-1, 2, 3}, {1, 5, 7}))) + 24), 1e-12);
}

TEST(Mesh, VolumeFarFromTheOriginLosesNothing) {
    // 1 cm at 64 m: terms measured from the origin would be 10^11 times the result.
    const double edge = double(64.0f + 1 / 128.0f) - 64;
    EXPECT_LE(std::abs(volume(box(vec3(64), vec3(64 + 1 / 128.0f))) / (edge * edge * edge) - 1), 1e-12);
}

TEST(Mesh, VolumeOfASphere) {
    const double ball = 4.0 / 3 * M_PI * 0.001;
    EXPECT_LE(std::abs(volume(sphere({1, 2, 3}, 0.1f, 6)) / ball - 1), 1e-3);
}

// Also in single precision, of triangles a thousand times as long as they are wide, whatever corner comes
// first.
TEST(Triangle, NearestPointOfASliver) {
    std::mt19937 random(4);
    auto any = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int round = 0; round < 10'000; ++round) {
        std::array<vec3, 3> t{vec3(4.5f, 4.5f, 4.5f), vec3(4.5f, any(5, 8), 4.5f),
                              vec3(4.5f, any(4, 8), any(900, 1300))};
        std::ranges::rotate(t, t.begin() + round % 3);
        const vec3 p(any(3, 6), any(4, 8), any(0, 1300));
        const vec3 one = nearest_weights(p, t[0], t[1], t[2]);
        const dvec3 exact = nearest_weights(dvec3(p), dvec3(t[0]), dvec3(t[1]), dvec3(t[2]));
        const double far =
            glm::distance(dvec3(p), exact.x * dvec3(t[0]) + exact.y * dvec3(t[1]) + exact.z * dvec3(t[2]));
        ASSERT_LE(std::abs(glm::distance(p, one.x * t[0] + one.y * t[1] + one.z * t[2]) - far), 1e-2)
            << round;
    }
}

TEST(Mesh, NormalsOfASphere) {
    const vec3 centre(0.3f, -0.1f, 0.2f);
    Mesh mesh = sphere(centre, 0.1f, 5);
    compute_normals(mesh);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    float worst = 0;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        EXPECT_LE(std::abs(glm::length(mesh.normals[i]) - 1), 1e-6f);
        worst = std::max(worst, glm::distance(mesh.normals[i], glm::normalize(mesh.positions[i] - centre)));
    }
    EXPECT_LE(worst, 0.006f);
}

TEST(Mesh, NormalsOfABoxDoNotDependOnItsDiagonals) {
    // Each corner has one to two faces a side, but always a right angle a side: so the weights are equal.
    Mesh mesh = box(vec3(-1), vec3(1));
    compute_normals(mesh);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        EXPECT_LE(glm::distance(mesh.normals[i], mesh.positions[i] / std::sqrt(3.0f)), 1e-6f);
}

TEST(Mesh, NormalsDoNotDependOnSize) {
    for (float size : {1e-12f, 1e-6f, 1e6f, 1e12f}) {
        Mesh mesh = box(vec3(-size), vec3(size));
        compute_normals(mesh);
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            EXPECT_LE(glm::distance(mesh.normals[i], mesh.positions[i] / (size * std::sqrt(3.0f))), 1e-6f)
                << size;
    }
}

TEST(Mesh, NormalsWhereThereIsNoFacePointUp) {
    Mesh mesh{{vec3(0), vec3(1, 0, 0), vec3(2, 0, 0), vec3(5)}, {}, {{0, 1, 2}, {0, 0, 0}}};
    compute_normals(mesh);
    for (vec3 n : mesh.normals) EXPECT_EQ(n, vec3(0, 0, 1));
}

TEST(Mesh, RotateTurnsAboutXThenYThenZ) {
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.normals = mesh.positions;
    Mesh up = mesh;
    rotate(up, {-90, 0, 0});
    EXPECT_LE(glm::distance(up.positions[2], vec3(0, 1, 0)), 1e-7f) << "z up becomes y up";
    EXPECT_LE(glm::distance(up.positions[1], vec3(0, 0, -1)), 1e-7f);
    EXPECT_LE(glm::distance(up.normals[2], vec3(0, 1, 0)), 1e-7f);

    rotate(mesh, {90, 90, 90});  // y: to z by x, to x by y, to y by z
    EXPECT_LE(glm::distance(mesh.positions[1], vec3(0, 1, 0)), 1e-7f);
    EXPECT_LE(glm::distance(mesh.positions[0], vec3(0, 0, -1)), 1e-7f);
}

TEST(Mesh, RotateKeepsShape) {
    Mesh mesh = sphere(vec3(0.1f), 0.1f, 3);
    const double before = volume(mesh);
    rotate(mesh, {12, -34, 56});
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 1e-6);
}

// A sphere with longitude and latitude as texture coordinates, without its poles and seam.
Mesh globe(bool mirrored) {
    Mesh mesh;
    const int across = 24, up = 12;
    for (int j = 0; j <= up; ++j)
        for (int i = 0; i <= across; ++i) {
            const float u = float(i) / across, v = float(j) / up;
            const float longitude = 6.0f * u, latitude = 2.4f * (v - 0.5f);
            mesh.positions.push_back({std::cos(longitude) * std::cos(latitude),
                                      std::sin(longitude) * std::cos(latitude), std::sin(latitude)});
            mesh.uvs.push_back({mirrored ? -u : u, v});
        }
    mesh.normals = mesh.positions;
    for (unsigned j = 0; j < up; ++j)
        for (unsigned i = 0; i < across; ++i) {
            const unsigned a = j * (across + 1) + i, b = a + 1, c = b + across + 1, d = a + across + 1;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

TEST(Mesh, TangentsRunAlongTheTexture) {
    for (bool mirrored : {false, true}) {
        Mesh mesh = globe(mirrored);
        compute_tangents(mesh);
        ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const vec3 east = glm::normalize(glm::cross(vec3(0, 0, 1), mesh.positions[i]));
            const vec3 tangent(mesh.tangents[i]);
            EXPECT_LE(glm::distance(tangent, mirrored ? -east : east), 0.15f);
            EXPECT_LE(std::abs(glm::length(tangent) - 1), 1e-6f);
            EXPECT_LE(std::abs(glm::dot(tangent, mesh.normals[i])), 1e-6f);
            EXPECT_EQ(mesh.tangents[i].w, mirrored ? -1.0f : 1.0f);
        }
    }
}

TEST(Mesh, TangentsDoNotDependOnSizeOrOnTheTexturesScale) {
    Mesh mesh = globe(false);
    compute_tangents(mesh);
    for (float size : {1e-6f, 1e6f}) {
        Mesh other = globe(false);
        for (vec3& p : other.positions) p *= size;
        for (vec2& uv : other.uvs) uv *= 0.001f;
        compute_tangents(other);
        for (std::size_t i = 0; i < mesh.tangents.size(); ++i)
            EXPECT_LE(glm::distance(vec3(other.tangents[i]), vec3(mesh.tangents[i])), 1e-3f) << size;
    }
}

TEST(Mesh, TangentsWithoutATextureAreUprightAllTheSame) {
    Mesh mesh = sphere(vec3(0), 1, 3);
    mesh.uvs.assign(mesh.positions.size(), vec2(0.5f));
    compute_tangents(mesh);  // makes the normals, too
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        EXPECT_LE(std::abs(glm::length(vec3(mesh.tangents[i])) - 1), 1e-6f);
        EXPECT_LE(std::abs(glm::dot(vec3(mesh.tangents[i]), mesh.normals[i])), 1e-6f);
    }
}

TEST(Mesh, RotateTurnsTangents) {
    Mesh mesh = globe(false);
    compute_tangents(mesh);
    Mesh turned = mesh;
    rotate(turned, {12, -34, 56});
    compute_tangents(mesh = turned);
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i)
        EXPECT_LE(glm::distance(mesh.tangents[i], turned.tangents[i]), 1e-5f);
}

}  // namespace
}  // namespace palpate
