// What a scene without a camera shows: all that matters, large enough.
#include "palpate/run/framing.h"

#include "palpate/render/view.h"
#include "palpate/scene/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr float wide = 1.6f;  // as a picture is high

struct Framed {
    Scene scene;
    Models made;
    Camera camera;

    explicit Framed(const std::string& text, float aspect = wide)
        : scene(parse_scene(text, "test.toml", ".")),
          made(build(scene)),
          camera(camera_of(scene, made, aspect)) {}

    // Where a point is in the picture: from -1 to 1 both ways. NaN behind the eye.
    vec2 at(vec3 p, float aspect = wide) const {
        const vec4 clip = view(camera, aspect, Extent{p, 1}).to_clip * vec4(p, 1);
        return clip.w > 0 ? vec2(clip) / clip.w : vec2(NAN);
    }
    bool shows(vec3 p, float aspect = wide) const {
        const vec2 place = at(p, aspect);
        return std::abs(place.x) <= 1 && std::abs(place.y) <= 1;
    }
    // How much of the picture's height and width the first body takes, whichever is more.
    float part() const {
        vec2 low(INFINITY), high(-INFINITY);
        for (vec3 p : made.models[0].surface.positions)
            low = glm::min(low, at(p)), high = glm::max(high, at(p));
        return 0.5f * std::max(high.x - low.x, high.y - low.y);
    }
    void expect_whole_bodies(float aspect = wide) const {
        for (const Model& model : made.models)
            for (vec3 p : model.surface.positions)
                ASSERT_TRUE(shows(p, aspect)) << p.x << ' ' << p.y << ' ' << p.z;
    }
};

// So many nodes a centimetre apart, times `size`, at a place.
std::string box(float size = 1, vec3 place = vec3(0), const std::string& dims = "[6, 5, 4]") {
    return fmt::format(
        "[[body]]\nname = \"box\"\ndims = {}\nspacing = {}\nmove = [{}, {}, {}]\ndensity = "
        "1000\nyoungs_modulus = "
        "2000\n",
        dims, 0.01 * size, place.x, place.y, place.z);
}
const std::string ground = "[[collider]]\nplane = {}\n";

TEST(Framing, BodiesFillThePictureWhereverAndHoweverLargeTheyAre) {
    for (const float size : {0.01f, 1.0f, 1000.0f})
        for (const vec3 place : {vec3(0), vec3(3, -70, 200) * size})
            for (const char* dims : {"[6, 5, 4]", "[30, 2, 3]", "[2, 30, 3]", "[3, 2, 30]", "[20, 2, 20]"})
                for (const float aspect : {0.5f, 1.0f, 2.3f}) {
                    const Framed framed(box(size, place, dims), aspect);
                    framed.expect_whole_bodies(aspect);
                    if (aspect == 1)
                        EXPECT_GT(Framed(box(size, place, dims)).part(), 0.8f) << size << ' ' << dims;
                }
}

TEST(Framing, AlsoWhereSightLinesAreParallel) {
    const Framed framed(box(1, vec3(5)) + "[camera]\nprojection = \"orthographic\"\n");
    framed.expect_whole_bodies();
    EXPECT_GT(framed.part(), 0.8f);
}

TEST(Framing, GroundsCollidersAndTipsAreThereToo) {
    const Framed framed(
        box(1, {0, 0.1f, 0}) + ground +
        "[[collider]]\nsphere = { centre = [0.1, 0.1, 0], radius = 0.03 }\n"
        "[[tool]]\nradius = 0.004\nfrom = [0.025, 0.4, 0.015]\npath = [[0, 0, 0.05, 0], [1, 0, -0.01, 0]]\n");
    framed.expect_whole_bodies();
    EXPECT_TRUE(framed.shows({0.02f, 0, 0.02f})) << "below the body, where it falls";
    EXPECT_TRUE(framed.shows({0.13f, 0.1f, 0})) << "the ball's far side";
    EXPECT_TRUE(framed.shows({0.025f, 0.144f + 0.05f, 0.015f})) << "the tip, where it begins";
    EXPECT_GT(framed.part(), 0.2f);
}

TEST(Framing, WhatMovesIsThereAllTheTime) {
    const Framed framed(box() +
                        "[[move]]\nnodes = { near = [0, 0, 0] }\npath = [[0, 0, 0, 0], [1, -0.2, 0, 0]]\n"
                        "[[collider]]\nsphere = { centre = [0.1, 0, 0], radius = 0.02 }\n"
                        "path = [[0, 0, 0, 0], [1, 0, 0.1, 0]]\n");
    EXPECT_TRUE(framed.shows({-0.2f, 0, 0}));
    EXPECT_TRUE(framed.shows({0.1f, 0.12f, 0}));
}

// The camera is the same with them and without, or nearly.
TEST(Framing, NothingFarOrEndlessMakesABodyADot) {
    const Framed alone(box());
    for (const char* far : {"[[collider]]\nplane = { offset = -50 }\n",
                            "[[collider]]\nsphere = { centre = [90, 0, 0], radius = 1 }\n",
                            "[[tool]]\nradius = 0.004\npath = [[0, 0, 60, 0], [1, 0, 50, 0]]\n"}) {
        const Framed with(box() + far);
        EXPECT_EQ(with.camera.eye, alone.camera.eye) << far;
        EXPECT_EQ(with.camera.look_at, alone.camera.look_at) << far;
    }
    EXPECT_GT(Framed(box() + ground).part(), 0.6f);
    EXPECT_GT(Framed(box() + "[[collider]]\nbox = { centre = [0, -10, 0], half = [20, 10, 20] }\n").part(),
              0.3f);
}

TEST(Framing, UpIsAgainstGravity) {
    const Framed y(box(1, vec3(0), "[6, 5, 4]")),
        z("[simulation]\ngravity = [0, 0, -9.81]\n" + box(1, vec3(0), "[6, 4, 5]"));
    const vec3 from_y = glm::normalize(y.camera.eye - y.camera.look_at),
               from_z = glm::normalize(z.camera.eye - z.camera.look_at);
    EXPECT_LE(glm::distance(from_z, vec3(from_y.x, -from_y.z, from_y.y)), 1e-5f);
    EXPECT_EQ(z.camera.up, vec3(0, 0, 1));
    EXPECT_LE(glm::distance(z.scene.light.direction, vec3(0.55f, 0.35f, -1)), 1e-6f)
        << "light from above, too";
    const Framed none("[simulation]\ngravity = [0, 0, 0]\n" + box());
    EXPECT_EQ(none.camera.up, vec3(0, 1, 0));
}

TEST(Framing, FromTheSideThatTipsComeFrom) {
    const Framed behind(
        box() + "[[tool]]\nradius = 0.004\npath = [[0, 0.02, 0.02, -0.05], [1, 0.02, 0.02, -0.01]]\n");
    EXPECT_LT(behind.camera.eye.z, behind.camera.look_at.z);
}

TEST(Framing, WhatTheSceneSaysHolds) {
    const Framed both(box() +
                      "[camera]\neye = [1, 2, 3]\nlook_at = [0, 0.01, 0]\nup = [0, 0, 1]\nangle = 20\n");
    EXPECT_EQ(both.camera.eye, vec3(1, 2, 3));
    EXPECT_EQ(both.camera.look_at, vec3(0, 0.01f, 0));
    EXPECT_EQ(both.camera.up, vec3(0, 0, 1));
    EXPECT_EQ(both.camera.angle, 20);
    const Framed eye(box(1, vec3(7, 8, 9)) + "[camera]\neye = [7, 8, 10]\n");
    EXPECT_EQ(eye.camera.eye, vec3(7, 8, 10));
    EXPECT_LE(glm::distance(eye.camera.look_at, vec3(7.025f, 8.02f, 9.015f)), 1e-3f);
    const Framed at(box(1, vec3(7, 8, 9)) + "[camera]\nlook_at = \"box\"\n");
    EXPECT_LE(glm::distance(at.camera.look_at, vec3(7.025f, 8.02f, 9.015f)), 1e-3f);
    at.expect_whole_bodies();
}

TEST(Framing, ASceneOfNothingHasACameraToo) {
    Scene scene;
    Models made;
    for (int grounds = 0; grounds < 2; ++grounds) {
        const Camera camera = camera_of(scene, made, wide);
        EXPECT_TRUE(std::isfinite(camera.eye.x) && camera.eye != camera.look_at);
        scene.colliders.emplace_back();
        made.simulation.colliders.emplace_back();
        made.pivots.emplace_back(0);
    }
}

}  // namespace
}  // namespace palpate
