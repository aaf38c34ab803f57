// What a pointer does in a picture: it turns the view and picks, and reaches in with hands. The events are
// made up.
#include "palpate/base/files.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/viewer/viewer_test.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

// ---- the camera, and what lies under a pointer ----

Camera random_camera(std::mt19937& random) {
    std::uniform_real_distribution<float> number(-1, 1);
    return {.eye = vec3(number(random), number(random), number(random)) + vec3(0, 0, 2),
            .look_at = 0.3f * vec3(number(random), number(random), number(random)),
            .angle = 35 + 20 * number(random),
            .orthographic = number(random) > 0};
}

TEST(Orbit, ARayGoesThroughThePixelOfItsPoints) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> across(0, 320), down(0, 240), way(0.5f, 3);
    for (int i = 0; i < 200; ++i) {
        const Camera camera = random_camera(random);
        const vec2 pixel(across(random), down(random));
        const Ray ray = ray_through(camera, pixel, size);
        EXPECT_NEAR(glm::length(ray.along), 1, 1e-5);
        const auto back = pixel_of(camera, ray.at(way(random)), size);
        ASSERT_TRUE(back);
        EXPECT_TRUE(glm::distance(*back, pixel) < 0.02f) << back->x << " " << pixel.x;
    }
}

TEST(Orbit, TheMiddleStaysAndTheSkyStaysAbove) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> pixels(-300, 300);
    Orbit orbit({.eye = vec3(0.3f, 0.2f, 0.4f), .look_at = vec3(0.1f, 0, 0)});
    const float distance = glm::distance(orbit.camera().eye, orbit.camera().look_at);
    for (int i = 0; i < 500; ++i) {
        orbit.turn(vec2(pixels(random), pixels(random)), 240);
        EXPECT_EQ(orbit.camera().look_at, vec3(0.1f, 0, 0));
        EXPECT_TRUE(std::abs(glm::distance(orbit.camera().eye, orbit.camera().look_at) - distance) < 1e-4f);
        const vec3 back = glm::normalize(orbit.camera().eye - orbit.camera().look_at);
        EXPECT_TRUE(std::abs(back.y) < 0.99995f) << back.y;
    }
    orbit.reset();
    EXPECT_EQ(orbit.camera().eye, vec3(0.3f, 0.2f, 0.4f));
}

TEST(Orbit, PanningTakesThePointUnderThePointerAlong) {
    Orbit orbit({.eye = vec3(0, 0, 1), .look_at = vec3(0)});
    const auto before = pixel_of(orbit.camera(), vec3(0), size);
    orbit.pan(vec2(30, -17), size.y);
    const auto after = pixel_of(orbit.camera(), vec3(0), size);
    EXPECT_TRUE(glm::distance(*after - *before, vec2(30, -17)) < 0.01f);
}

TEST(Orbit, FramingShowsAllOfABox) {
    std::mt19937 random(3);
    Orbit orbit(random_camera(random));
    Bounds box;
    box.include(vec3(-0.2f, 0.1f, 3));
    box.include(vec3(0.5f, 0.3f, 3.2f));
    orbit.frame(box);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 p(corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                     corner & 4 ? box.low.z : box.high.z);
        const auto pixel = pixel_of(orbit.camera(), p, size);
        ASSERT_TRUE(pixel);
        EXPECT_TRUE(pixel->x > 0 && pixel->x < 320 && pixel->y > 0 && pixel->y < 240) << corner;
    }
}

TEST(Pick, FindsTheNearestOfABallsTwoSides) {
    const Mesh ball = ellipsoid(vec3(0.1f), 40);
    const std::vector<Skin> skins = {{ball.positions, ball.normals, &ball.triangles}};
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 300; ++i) {
        const vec3 from = 0.5f * glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const vec3 at = 0.12f * glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const Ray ray{from, glm::normalize(at - from)};
        const float along = -glm::dot(from, ray.along);
        const float aside = glm::length(from + along * ray.along);
        const auto hit = pick(ray, skins);
        if (aside > 0.1f) EXPECT_FALSE(hit);
        if (aside > 0.098f) continue;
        ASSERT_TRUE(hit);
        EXPECT_TRUE(std::abs(hit->way - (along - std::sqrt(0.01f - aside * aside))) < 0.003f);
        EXPECT_LT(glm::dot(hit->normal, ray.along), 0);
    }
}

// ---- reaching in ----

TEST_F(ViewerTest, APullTakesTheSurfaceAlongUntilItIsReleased) {
    open("box");
    viewer.advance(900);  // until it hangs still
    const vec2 from = middle(), to = from + vec2(0, -60);
    const dvec3 before = state().positions[456];
    drag(from, to, 20);
    for (int f = 0; f < 60; ++f) viewer.advance(1);
    ASSERT_EQ(viewer.holds().size(), 1u);
    EXPECT_GT(state().positions[456].y, before.y + 0.004);
    ASSERT_EQ(viewer.arrows().size(), 1u);
    EXPECT_LT(viewer.arrows()[0].force.y, 0);  // it pulls back
    EXPECT_TRUE(viewer.touched());
    viewer.release(Button::left);
    EXPECT_TRUE(viewer.holds().empty());
    viewer.advance(900);
    EXPECT_NEAR(state().positions[456].y, before.y, 0.001);
}

TEST_F(ViewerTest, AHandIsWhereThePointerIs) {
    open("box");
    drag(middle(), middle() + vec2(25, -40), 10);
    for (int f = 0; f < 30; ++f) viewer.advance(1);
    const auto at = pixel_of(viewer.camera(), viewer.holds()[0].place(), viewer.view_size());
    const auto target = pixel_of(viewer.camera(), viewer.holds()[0].target(), viewer.view_size());
    EXPECT_TRUE(glm::distance(*at, *target) < 0.5f);
}

TEST_F(ViewerTest, APressPushesInAndTheWheelDeeper) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.move_pointer(middle());
    viewer.advance(1);
    viewer.press(Button::left);
    EXPECT_TRUE(viewer.is_holding());
    const double patience = viewer.experiment()->time() + 20;
    auto wait_for = [&](float newtons) {
        while (force() < newtons && viewer.experiment()->time() < patience) live(10);
    };
    wait_for(0.05f);
    for (int i = 0; i < 100; ++i) live(10);  // it comes to rest
    const float first = force();
    EXPECT_GT(first, 0.05f);
    const vec3 forward = glm::normalize(viewer.camera().look_at - viewer.camera().eye);
    EXPECT_LT(glm::dot(vec3(viewer.experiment()->play().interaction_forces().presses.at(0)), forward), 0);
    EXPECT_TRUE(viewer.feeling()->felt().count == 0);  // no dent in what moves
    viewer.wheel(2);
    wait_for(1.1f * first);
    EXPECT_GT(force(), 1.1f * first);
    viewer.release(Button::left);
    viewer.advance(1);
    viewer.advance(1);
    EXPECT_TRUE(viewer.experiment()->play().interaction_forces().presses.empty());
}

// However soft a body is and however deep one pushes: the ball stays at its surface.
TEST_F(ViewerTest, TheHandIsNotLostInside) {
    open("box", {"simulation.gravity=[0,0,0]", "body.1.youngs_modulus=1000"});
    viewer.options.tip = 0.006f;
    viewer.move_pointer(middle());
    viewer.advance(1);
    viewer.press(Button::left);
    viewer.wheel(20);
    float most = 0;
    for (int f = 0; f < 100; ++f) {
        viewer.move_pointer(middle() + vec2(std::sin(0.05f * float(f)) * 30, 0));
        live(10);
        const FeltHand& hand = *viewer.feeling();
        ASSERT_TRUE(glm::distance(hand.place(), hand.felt().proxy) < 1.21f * viewer.options.tip) << f;
        most = std::max(most, force());
    }
    EXPECT_GT(most, 0.05f);
    EXPECT_TRUE(viewer.experiment()->trouble().empty());
    EXPECT_EQ(viewer.experiment()->report().bodies[0].inverted_cells, 0u);
}

// On a thread of its own it advances while pictures are drawn.
TEST_F(ViewerTest, ItGoesOnWhileItIsDrawn) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.move_pointer(middle());
    viewer.advance(1);
    viewer.press(Button::left);
    const double start = viewer.experiment()->time();
    float most = 0;
    for (double time = 0; time < 0.5 || (most < 0.02f && time < 30);) {
        viewer.hold_still();
        viewer.advance(1);
        viewer.move_pointer(middle());
        viewer.look();
        viewer.go_on();
        ASSERT_TRUE(viewer.is_live());
        viewer.draw();
        viewer.hold_still();
        most = std::max(most, force());
        time = viewer.experiment()->time() - start;
    }
    EXPECT_GE(most, 0.02f);
    EXPECT_GT(viewer.image().pixels.size(), 0u);
    viewer.release(Button::left);
    viewer.advance(1);
    EXPECT_FALSE(viewer.is_live());
    const double still = viewer.experiment()->time();
    viewer.go_on();
    viewer.draw();
    viewer.hold_still();
    EXPECT_EQ(viewer.experiment()->time(), still);
    EXPECT_TRUE(viewer.experiment()->trouble().empty());
}

// A body keeps no dents, also not when the hand lets go of it.
TEST_F(ViewerTest, APressLeavesNoDentInABody) {
    open("box", {"simulation.gravity=[0,0,0]", "body.1.touch.yield=0"});
    viewer.move_pointer(middle());
    viewer.advance(1);
    viewer.press(Button::left);
    for (int i = 0; i < 300 && force() < 0.05f; ++i) live(10);
    EXPECT_GE(force(), 0.05f);
    viewer.options.paused = true;
    for (int i = 0; i < 5; ++i) live(10);
    viewer.options.paused = false;
    viewer.release(Button::left);
    for (int i = 0; i < 10; ++i) {
        live(10);
        EXPECT_EQ(viewer.feeling()->felt().lasting, 0);
    }
    EXPECT_FALSE(viewer.can_undo());
}

// What is on a GPU advances where its context is, so both of a comparison do.
TEST_F(ViewerTest, AHandPressesBothOfAComparison) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.options.compared = {.with = Compared::With::backend, .backend = Backend::compute};
    viewer.advance(1);
    ASSERT_TRUE(viewer.beside()) << viewer.message().text;
    viewer.move_pointer(middle());
    viewer.advance(1);
    viewer.press(Button::left);
    for (int i = 0; i < 300 && force() < 0.05f; ++i) {
        live(10);
        EXPECT_FALSE(viewer.is_live());
    }
    EXPECT_GE(force(), 0.05f);
    EXPECT_EQ(viewer.experiment()->time(), viewer.beside()->time());
    const auto here = viewer.experiment()->play().nodes(0).positions,
               there = viewer.beside()->play().nodes(0).positions;
    for (std::size_t i = 0; i < here.size(); ++i) EXPECT_TRUE(glm::distance(here[i], there[i]) < 1e-3f) << i;
}

TEST_F(ViewerTest, AsManyHandsAsOneLikes) {
    open("box");
    int held = 0;
    for (int i = 0; i < 12; ++i) {
        viewer.move_pointer(middle() + vec2(6 * i - 30, 0));
        viewer.press(Button::left, true);
        if (viewer.is_holding()) ++held;
        viewer.keep();
        viewer.release(Button::left);
        viewer.advance(1);
    }
    EXPECT_EQ(held, 12);
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    EXPECT_TRUE(viewer.experiment()->trouble().empty());
    viewer.keep();
    EXPECT_TRUE(viewer.holds().empty());
}

TEST_F(ViewerTest, BesideTheSurfaceItTurnsTheView) {
    open("box");
    const vec3 eye = viewer.camera().eye;
    drag(vec2(310, 5), vec2(280, 20), 4);
    EXPECT_TRUE(viewer.holds().empty());
    EXPECT_GT(glm::distance(viewer.camera().eye, eye), 0.01f);
    viewer.release(Button::left);
    drag(vec2(100, 100), vec2(120, 100), 4, Button::right);
    viewer.release(Button::right);
    viewer.wheel(2);
    viewer.reset_camera();
    EXPECT_EQ(viewer.camera().eye, eye);
}

TEST_F(ViewerTest, PinsAreSetUndoneAndSetAgain) {
    open("box");
    viewer.advance(10);
    viewer.options.mode = Mode::pin;
    viewer.options.tip = 0.002f;
    const auto pinned = [&] {
        const auto& masses = viewer.experiment()->models().models[0].body.inverse_mass;
        return std::count(masses.begin(), masses.end(), 0.0f);
    };
    const auto before = pinned();
    viewer.move_pointer(middle());
    viewer.press(Button::left);
    viewer.release(Button::left);
    EXPECT_GT(pinned(), before) << viewer.message().text;
    viewer.undo();
    EXPECT_EQ(pinned(), before);
    viewer.redo();
    EXPECT_GT(pinned(), before);
    viewer.press(Button::left);  // the same place once more lets go
    EXPECT_EQ(pinned(), before);
}

TEST_F(ViewerTest, TheHandThatDentsFeelsAndIsSeen) {
    open_still();
    viewer.options.look.culling = true;
    const Image before = viewer.image();
    viewer.move_pointer(middle());
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    viewer.press(Button::left);
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().count > 0; });
    EXPECT_GT(difference(viewer.image(), before), 0.03);
    EXPECT_GT(viewer.feeling()->loop().timing().periods.count(), 0u);
    viewer.release(Button::left);
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().count == 0; });
    viewer.options.mode = Mode::pin;
    viewer.advance(1);
    EXPECT_FALSE(viewer.feeling());
    EXPECT_TRUE(difference(viewer.image(), before) < 0.02);
}

// A surface in which dents stay; a hand that only goes by leaves none, and what one leaves can be taken back.
TEST_F(ViewerTest, WhatStaysOfDentsIsTakenBack) {
    open_still({"surface.1.touch.yield=0", "surface.1.touch.width=0.004"});
    viewer.options.paused = true;
    viewer.options.tip = 0.004f;
    auto until = [&](auto holds) { wait_until(viewer, 1, holds); };
    auto ticks = [&] { return viewer.feeling() ? viewer.feeling()->loop().timing().periods.count() : 0; };
    auto lasting = [&] { return viewer.feeling()->felt().lasting; };
    // From below the body to above it and back: through it, if the hand went straight.
    for (int i = 0; i < 20; ++i) {
        viewer.move_pointer(middle() + vec2(0, i % 2 ? 90 : -90));
        viewer.advance(1);
        until([&, before = ticks()] { return ticks() > before + 30; });
    }
    viewer.move_pointer(middle());
    until([&, before = ticks()] { return ticks() > before + 100; });
    EXPECT_EQ(lasting(), 0);
    EXPECT_FALSE(viewer.can_undo());
    const Image untouched = viewer.image();

    const vec2 places[] = {middle() + vec2(-40, 0), middle() + vec2(40, 0)};
    for (vec2 place : places) {
        const int before = lasting();
        viewer.move_pointer(place);
        viewer.advance(1);
        viewer.press(Button::left);
        until([&] { return lasting() > before; });
        viewer.release(Button::left);
        until([&] { return viewer.feeling()->felt().count == lasting(); });
    }
    const Image twice = viewer.image();
    EXPECT_GT(difference(twice, untouched), 0.01);
    for (int i = 0; i < viewer.feeling()->felt().count; ++i)
        EXPECT_LE(viewer.feeling()->felt().dents[std::size_t(i)].depth, 0.0041f);
    // A change of the scene that came later goes first.
    viewer.change({"surface.1.touch.stiffness=250"});
    viewer.undo();
    viewer.advance(1);
    const int both = lasting();
    viewer.undo();
    until([&] { return lasting() < both; });
    EXPECT_GT(lasting(), 0);
    EXPECT_TRUE(viewer.can_undo());
    viewer.restart();
    viewer.move_pointer(middle());
    until([&, before = ticks()] { return lasting() == 0 && ticks() > before + 100; });
    EXPECT_FALSE(viewer.can_undo());
    viewer.options.paused = true;
    EXPECT_TRUE(difference(viewer.image(), untouched) < 0.02);
}

TEST_F(ViewerTest, ASliderLeavesTheHandsDeviceOpen) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    const FeltHand* hand = viewer.feeling();
    const LoopTiming* timing = &hand->loop().timing();
    for (int i = 1; i <= 3; ++i) {
        viewer.change({"body.1.touch.width=0.00" + std::to_string(i)}, i > 1);
        viewer.options.tip = 0.002f * float(i);
        viewer.advance(1);
        EXPECT_EQ(viewer.feeling(), hand);
        EXPECT_EQ(&viewer.feeling()->loop().timing(), timing);
    }
    viewer.change({"body.1.mapping=\"one-to-one\""});  // how surfaces hang, too
    viewer.advance(1);
    EXPECT_EQ(viewer.feeling(), hand);
    EXPECT_TRUE(viewer.message().text.find("error") == std::string::npos);
}

// All of a picture is of one tick, though the loop goes on.
TEST_F(ViewerTest, APictureShowsOneTick) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.move_pointer(middle());
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling());
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().time > 0; });
    const double time = viewer.feeling()->felt().time;
    const auto ticks = viewer.feeling()->loop().timing().periods.count();
    while (viewer.feeling()->loop().timing().periods.count() < ticks + 5) viewer.image();
    EXPECT_EQ(viewer.feeling()->felt().time, time);
    viewer.advance(1);
    EXPECT_GT(viewer.feeling()->felt().time, time);
}

TEST_F(ViewerTest, AnotherDeviceOrWhyNot) {
    open("box", {"simulation.gravity=[0,0,0]"});
    const Scratch scratch;
    viewer.options.device = "script";
    viewer.options.device_file = (scratch / "nowhere.csv").string();
    viewer.advance(1);
    EXPECT_FALSE(viewer.feeling());
    EXPECT_TRUE(viewer.message().bad);
    EXPECT_NE(viewer.message().text.find("nowhere.csv"), std::string::npos);
    write_text(scratch / "path.csv", "0,0.1,0.2,0.02\n1,0.1,0.2,0.02\n");
    viewer.options.device = "script";
    viewer.options.device_file = (scratch / "path.csv").string();
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().time != 0; });
    EXPECT_TRUE(glm::distance(viewer.feeling()->felt().pose.place, dvec3(0.1, 0.2, 0.02)) < 1e-4);
}

TEST_F(ViewerTest, ADevicePressesAndPullsAsWell) {
    open("box", {"simulation.gravity=[0,0,0]"});
    const Scratch scratch;
    // It comes down on the beam's upper side, waits, and goes up.
    std::string path;
    for (int i = 0; i < 1000; ++i)
        for (const auto& [after, height] : {std::pair(0.0, 0.09), {0.2, 0.09}, {0.5, 0.045}, {2.8, 0.045}})
            path += fmt::format("{},0.15,{},0.025\n", 3 * i + after, height);
    write_text(scratch / "path.csv", path);
    viewer.options.device = "script";
    viewer.options.device_file = (scratch / "path.csv").string();
    const double before = state().positions[456].y;
    wait_until(viewer, 1, [&] { return state().positions[456].y < before - 0.001; });
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().force.y > 0.01f; });
    ASSERT_EQ(viewer.arrows().size(), 1u);
    viewer.options.device = "mouse";
    viewer.advance(2);
    EXPECT_TRUE(viewer.holds().empty());
    EXPECT_TRUE(viewer.arrows().empty());
}

// It grasps what it touches while its first button is pressed.
TEST_F(ViewerTest, ADevicesButtonGrasps) {
    open("box", {"simulation.gravity=[0,0,0]"});
    Holds holds;
    Felt felt;
    felt.pose.place = dvec3(0.15, 0.05, 0.025);
    felt.buttons = 1;
    holds.follow(*viewer.experiment(), felt, 0.01f);
    EXPECT_TRUE(holds.all().empty());  // it touches nothing
    felt.surface = 0;
    holds.follow(*viewer.experiment(), felt, 0.01f);
    ASSERT_EQ(holds.all().size(), 1u);
    EXPECT_GT(holds.all()[0].pulls(), 0u);
    felt.surface = -1;
    felt.pose.place.y = 0.06;
    holds.follow(*viewer.experiment(), felt, 0.01f);
    ASSERT_EQ(holds.all().size(), 1u);
    EXPECT_EQ(holds.all()[0].place().y, 0.06f);
    felt.buttons = 0;
    holds.follow(*viewer.experiment(), felt, 0.01f);
    EXPECT_TRUE(holds.all().empty());
}

}  // namespace
}  // namespace palpate
