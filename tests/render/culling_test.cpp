// What is left out before it is mapped has no pixel.
#include "bench/deformations.h"
#include "palpate/base/error.h"
#include "palpate/gl/context.h"
#include "palpate/render/clusters.h"
#include "palpate/render/renderer.h"
#include "tests/gl/with_context.h"
#include "tests/render/gpu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <set>

namespace palpate {
namespace {

// A triangle from its least corner on, turning as it did.
std::array<unsigned, 3> from_the_least(uvec3 t) {
    if (t.x < t.y && t.x < t.z) return {t.x, t.y, t.z};
    return t.y < t.z ? std::array{t.y, t.z, t.x} : std::array{t.z, t.x, t.y};
}

std::vector<std::array<unsigned, 3>> sorted(const std::vector<uvec3>& triangles) {
    std::vector<std::array<unsigned, 3>> list;
    for (uvec3 t : triangles) list.push_back(from_the_least(t));
    std::sort(list.begin(), list.end());
    return list;
}

TEST(Clustering, EachTriangleIsInOneClusterAndTurnsAsItDid) {
    std::mt19937 random(5);
    for (int rings : {3, 8, 41}) {
        Mesh mesh = ellipsoid({0.05f, 0.04f, 0.06f}, rings);
        std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
        for (const auto& [vertices, faces] : {std::pair{3u, 4u}, {64u, 124u}, {255u, 512u}}) {
            const Clusters made = clusters(mesh, vertices, faces);
            EXPECT_EQ(sorted(made.triangles), sorted(mesh.triangles));
            ASSERT_EQ(made.ends.back(), mesh.triangles.size());
            std::size_t begin = 0;
            for (std::size_t end : made.ends) {
                std::set<unsigned> members;
                for (std::size_t t = begin; t < end; ++t)
                    for (int k = 0; k < 3; ++k) members.insert(made.triangles[t][k]);
                EXPECT_LE(members.size(), vertices);
                EXPECT_LE(end - begin, faces);
                EXPECT_GT(end, begin);
                begin = end;
            }
        }
    }
    EXPECT_TRUE(clusters(Mesh{}, 64, 124).ends.empty());
}

class CullingTest : public WithContext {
 protected:
    void SetUp() override {
        WithContext::SetUp();
        if (context_) renderer_.emplace(Offscreen{200, 150}, context());
    }
    void TearDown() override {
        renderer_.reset();
        WithContext::TearDown();
    }

    Image image(const Picture& picture) {
        renderer_->draw(picture);
        return renderer_->image();
    }

    // From anywhere about a box: far off, near by and inside; or along parallel lines.
    Camera any_camera(const Bounds& box) {
        auto any = [&](float from, float to) {
            return std::uniform_real_distribution<float>(from, to)(random_);
        };
        auto any_vector = [&] { return vec3(any(-1, 1), any(-1, 1), any(-1, 1)); };
        const float size = glm::length(box.size());
        Camera camera;
        camera.look_at = box.centre() + 0.5f * box.size() * any_vector();
        const vec3 way = any_vector() + vec3(1e-3f);
        camera.eye = camera.look_at + size * std::exp(any(-3, 1)) * glm::normalize(way);
        camera.up = any_vector();
        camera.angle = any(5, 100);
        camera.orthographic = any(0, 1) < 0.3f;
        return camera;
    }

    // The same pixels with and without culling, from `cameras` places. Returns what was left out at most.
    double expect_same(const Surface& surface, const Bounds& box, int cameras, const std::string& where) {
        double most = 0;
        for (int i = 0; i < cameras; ++i) {
            Picture picture{.camera = any_camera(box), .surfaces = {surface}};
            picture.grounds = {{.offset = box.low.y}};
            picture.culls = false;
            const Image whole = image(picture);
            picture.culls = true;
            EXPECT_TRUE(image(picture).pixels == whole.pixels) << where << ", camera " << i;
            const Culled culled = renderer_->culled(surface.mesh);
            most = std::max(most, 1 - double(culled.vertices_drawn) / double(culled.vertices));
        }
        return most;
    }
    std::optional<Renderer> renderer_;
    std::mt19937 random_{7};
};

TEST_F(CullingTest, ThePictureIsTheSame) {
    for (const Carrier& c : carriers())
        for (Mapping mapping : {Mapping::one_to_one, Mapping::constant, Mapping::interpolated,
                                Mapping::normal_offset, Mapping::trilinear, Mapping::frames}) {
            if (mapping == Mapping::trilinear && c.body.cells.empty()) continue;
            const int number = renderer_->add(c.surface, embed(c.surface, c.body, mapping));
            double left_out = 0;
            std::vector<vec3> nodes = c.body.positions;
            for (int step = 0; step < 4; ++step) {
                const std::string where =
                    c.name + ", " + std::string(name_of(mapping)) + ", " + std::to_string(step);
                const std::vector<vec3> normals = approximate_normals(c.body, nodes);
                const NodeTextures textures(nodes, normals, 31);
                const NodeBuffers buffers(nodes, normals);
                const GpuNodes& on = step % 2 == 0 ? buffers.nodes : textures.nodes;
                left_out =
                    std::max(left_out, expect_same({.mesh = number, .gpu_nodes = on}, on.bounds, 2, where));
                // Twisted, bent too, and then every node somewhere else.
                std::uniform_real_distribution<float> off(-0.4f * c.body.spacing, 0.4f * c.body.spacing);
                if (step == 0) nodes = c.twisted(nodes);
                if (step == 1) nodes = c.bent(nodes);
                if (step == 2)
                    for (vec3& p : nodes) p += vec3(off(random_), off(random_), off(random_));
            }
            EXPECT_GE(left_out, 0.1) << c.name << ", " << name_of(mapping);
        }
}

// In cells that deform gently, what shows its back is left out: nearly half.
TEST_F(CullingTest, TheFarSideIsNotMapped) {
    for (int rings : {8, 25, 100}) {
        const Mesh surface = ellipsoid({0.05f, 0.04f, 0.06f}, rings);
        const Body body = lattice(ellipsoid({0.05f, 0.04f, 0.06f}, 50),
                                  {.spacing = 0.006f, .material = {.youngs_modulus = 5000, .density = 1000}});
        const int number = renderer_->add(surface, embed(surface, body));
        for (double angle : {0.0, 0.2, 1.5}) {
            const std::vector<vec3> nodes = bend({0, 0, 1}, {1, 0, 0}, 0.12, angle + 1e-9)(body.positions);
            const Surface seen{.mesh = number, .nodes = {nodes, {}}};
            expect_same(seen, bounds_of(nodes), 4, "bent by " + std::to_string(angle));
            if (rings < 100 || angle > 1) continue;
            renderer_->draw({.camera = {.eye = {0.4f, 0.3f, 0.2f}}, .surfaces = {seen}});
            const Culled culled = renderer_->culled(number);
            EXPECT_LE(double(culled.clusters_drawn), 0.8 * double(culled.clusters)) << angle;
            EXPECT_GE(double(culled.clusters_drawn), 0.5 * double(culled.clusters)) << angle;
        }
    }
}

TEST_F(CullingTest, WhatLiesBesideThePictureIsNotMapped) {
    const Carrier c = quilt_on_a_cloth();
    const int number = renderer_->add(c.surface, embed(c.surface, c.body));
    const Surface seen{.mesh = number, .nodes = {c.body.positions, {}}};
    for (const auto& [distance, most, least] : {std::tuple{1.0f, 1.0, 1.0}, {0.1f, 0.4, 0.02}}) {
        renderer_->draw({.camera = {.eye = {0, 0, distance}}, .surfaces = {seen}});
        const Culled culled = renderer_->culled(number);
        EXPECT_LE(double(culled.clusters_drawn), most * double(culled.clusters));
        EXPECT_GE(double(culled.clusters_drawn), least * double(culled.clusters));
    }
    // Behind the eye, nothing.
    renderer_->draw({.camera = {.eye = {0, 0, 0.5f}, .look_at = {0, 0, 1}}, .surfaces = {seen}});
    EXPECT_EQ(renderer_->culled(number).clusters_drawn, 0u);
}

}  // namespace
}  // namespace palpate
