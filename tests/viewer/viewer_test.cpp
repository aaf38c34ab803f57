// The viewer without a window: what a pointer does in a picture, and the controls, with events that are made
// up.
#include "app/viewer/viewer.h"

#include "app/viewer/gui.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"
#include "palpate/mesh/image.h"
#include "palpate/mesh/write.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/viewer/opened.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

constexpr ivec2 size(320, 240);

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

class ViewerTest : public testing::Test {
 protected:
    gl::Context context;
    Viewer viewer{context, size};

    void open(const std::string& scene, std::vector<Change> changes = {}) {
        viewer.open(find_scene(scene), std::move(changes));
        wait_until_open(viewer);
        ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    }
    // Where a node of the first body is in the picture.
    vec2 pixel(std::size_t node) {
        return *pixel_of(viewer.camera(), viewer.experiment()->play().nodes(0).positions[node],
                         viewer.view_size());
    }
    vec2 middle() {
        vec3 sum(0);
        const auto positions = viewer.experiment()->play().skins()[0].positions;
        for (vec3 p : positions) sum += p;
        return *pixel_of(viewer.camera(), sum / float(positions.size()), viewer.view_size());
    }
    void drag(vec2 from, vec2 to, int frames, Button button = Button::left) {
        viewer.move_pointer(from);
        viewer.press(button);
        for (int f = 1; f <= frames; ++f) {
            viewer.move_pointer(glm::mix(from, to, float(f) / float(frames)));
            viewer.advance(1);
        }
    }
    State state() { return viewer.experiment()->play().save()[0]; }
};

// How much two pictures differ, of 255; not a number if they have not the same size.
double difference(const Image& a, const Image& b) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return NAN;
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(int(a.pixels[i]) - int(b.pixels[i]));
    return sum / double(a.pixels.size());
}

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
    viewer.options.mode = Mode::press;
    viewer.move_pointer(middle());
    viewer.press(Button::left);
    ASSERT_EQ(viewer.holds().size(), 1u);
    for (int f = 0; f < 60; ++f) viewer.advance(1);
    const float first = glm::length(viewer.arrows()[0].force);
    EXPECT_GT(first, 0);
    const vec3 forward = glm::normalize(viewer.camera().look_at - viewer.camera().eye);
    EXPECT_LT(glm::dot(viewer.arrows()[0].force, forward), 0);  // against the eye's line
    viewer.wheel(1);
    for (int f = 0; f < 60; ++f) viewer.advance(1);
    EXPECT_GT(glm::length(viewer.arrows()[0].force), first);
    viewer.release(Button::left);
    EXPECT_TRUE(viewer.arrows().empty());
}

TEST_F(ViewerTest, SeveralHandsUntilNoMoreFit) {
    open("box");
    int held = 0;
    for (int i = 0; i < 12; ++i) {
        viewer.move_pointer(middle() + vec2(6 * i - 30, 0));
        viewer.press(Button::left);
        if (viewer.is_holding()) ++held;
        viewer.keep();
        viewer.release(Button::left);
        viewer.advance(1);
    }
    EXPECT_GE(held, 2);
    EXPECT_LE(held, 8);
    EXPECT_TRUE(viewer.message().bad) << viewer.message().text;
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
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.options.look.culling = true;
    const Image before = viewer.image();
    viewer.options.mode = Mode::dent;
    viewer.move_pointer(middle());
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    viewer.press(Button::left);
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().count > 0; });
    EXPECT_GT(difference(viewer.image(), before), 0.03);
    EXPECT_GT(viewer.feeling()->timing().periods.count(), 0u);
    viewer.release(Button::left);
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().count == 0; });
    viewer.options.mode = Mode::pull;
    viewer.advance(1);
    EXPECT_FALSE(viewer.feeling());
    EXPECT_TRUE(difference(viewer.image(), before) < 0.02);
}

// A surface in which dents stay; a hand that only goes by leaves none, and what one leaves can be taken back.
TEST_F(ViewerTest, WhatStaysOfDentsIsTakenBack) {
    open("box", {"simulation.gravity=[0,0,0]", "body.1.touch.yield=0", "body.1.touch.width=0.004"});
    viewer.options.paused = true;
    viewer.options.tip = 0.004f;
    viewer.options.mode = Mode::dent;
    auto until = [&](auto holds) { wait_until(viewer, 1, holds); };
    auto ticks = [&] { return viewer.feeling() ? viewer.feeling()->timing().periods.count() : 0; };
    auto lasting = [&] { return viewer.feeling()->felt().lasting; };
    // From below the body to above it and back: through it, if the hand went straight.
    for (int i = 0; i < 20; ++i) {
        viewer.move_pointer(middle() + vec2(0, i % 2 ? 90 : -90));
        viewer.advance(1);
        until([&, before = ticks()] { return ticks() > before + 30; });
    }
    viewer.move_pointer(middle());
    until([&] { return viewer.feeling() && viewer.feeling()->felt().time > 0; });
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
    viewer.change({"body.1.damping=3"});
    viewer.undo();
    viewer.advance(1);
    const int both = lasting();
    viewer.undo();
    until([&] { return lasting() < both; });
    EXPECT_GT(lasting(), 0);
    EXPECT_TRUE(viewer.can_undo());
    viewer.restart();
    until([&] { return lasting() == 0; });
    EXPECT_FALSE(viewer.can_undo());
    viewer.options.paused = true;
    EXPECT_TRUE(difference(viewer.image(), untouched) < 0.02);
}

TEST_F(ViewerTest, ASliderLeavesTheHandsDeviceOpen) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.options.mode = Mode::dent;
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    const FeelingHand* hand = viewer.feeling();
    const LoopTiming* timing = &hand->timing();
    for (int i = 1; i <= 3; ++i) {
        viewer.change({"body.1.touch.width=0.00" + std::to_string(i)}, i > 1);
        viewer.options.tip = 0.002f * float(i);
        viewer.advance(1);
        EXPECT_EQ(viewer.feeling(), hand);
        EXPECT_EQ(&viewer.feeling()->timing(), timing);
    }
    viewer.change({"body.1.mapping=\"one-to-one\""});  // how surfaces hang, too
    viewer.advance(1);
    EXPECT_EQ(viewer.feeling(), hand);
    EXPECT_TRUE(viewer.message().text.find("error") == std::string::npos);
}

// All of a picture is of one tick, though the loop goes on.
TEST_F(ViewerTest, APictureShowsOneTick) {
    open("box", {"simulation.gravity=[0,0,0]"});
    viewer.options.mode = Mode::dent;
    viewer.move_pointer(middle());
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling());
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().time > 0; });
    const double time = viewer.feeling()->felt().time;
    const auto ticks = viewer.feeling()->timing().periods.count();
    while (viewer.feeling()->timing().periods.count() < ticks + 5) viewer.image();
    EXPECT_EQ(viewer.feeling()->felt().time, time);
    viewer.advance(1);
    EXPECT_GT(viewer.feeling()->felt().time, time);
}

TEST_F(ViewerTest, AnotherDeviceOrWhyNot) {
    open("box", {"simulation.gravity=[0,0,0]"});
    const Scratch scratch;
    viewer.options.mode = Mode::dent;
    viewer.options.device = DeviceKind::script;
    viewer.options.device_file = (scratch / "nowhere.csv").string();
    viewer.advance(1);
    EXPECT_FALSE(viewer.feeling());
    EXPECT_TRUE(viewer.message().bad);
    EXPECT_NE(viewer.message().text.find("nowhere.csv"), std::string::npos);
    write_text(scratch / "path.csv", "0,0.1,0.2,0.02\n1,0.1,0.2,0.02\n");
    viewer.options.mode = Mode::dent;
    viewer.options.device = DeviceKind::script;
    viewer.options.device_file = (scratch / "path.csv").string();
    viewer.advance(1);
    ASSERT_TRUE(viewer.feeling()) << viewer.message().text;
    wait_until(viewer, 1, [&] { return viewer.feeling()->felt().time != 0; });
    EXPECT_TRUE(glm::distance(viewer.feeling()->felt().hand, vec3(0.1f, 0.2f, 0.02f)) < 1e-4f);
}

TEST_F(ViewerTest, ADevicePressesAndPullsAsWell) {
    open("box", {"simulation.gravity=[0,0,0]"});
    const Scratch scratch;
    // It comes down on the beam's upper side, waits, and goes up.
    write_text(scratch / "path.csv", "0,0.15,0.09,0.025\n0.3,0.15,0.045,0.025\n6000,0.15,0.045,0.025\n");
    viewer.options.device = DeviceKind::script;
    viewer.options.device_file = (scratch / "path.csv").string();
    viewer.options.mode = Mode::press;
    const double before = state().positions[456].y;
    wait_until(viewer, 1, [&] { return state().positions[456].y < before - 0.001; });
    ASSERT_EQ(viewer.arrows().size(), 1u);
    EXPECT_GT(viewer.arrows()[0].force.y, 0);
    viewer.options.device_file = (scratch / "path.csv").string();
    viewer.options.mode = Mode::pull;
    wait_until(viewer, 1, [&] { return !viewer.holds().empty() && !viewer.holds()[0].presses(); });
    ASSERT_EQ(viewer.holds().size(), 1u);
    EXPECT_GT(viewer.holds()[0].pulls(), 0u);
    viewer.options.device = DeviceKind::mouse;
    viewer.advance(2);
    EXPECT_TRUE(viewer.holds().empty());
    EXPECT_FALSE(viewer.feeling());
}

// ---- pictures ----

TEST_F(ViewerTest, TheSameSceneSideBySideIsTheSame) {
    open("box");
    viewer.advance(20);
    viewer.options.compared = {.with = Compared::With::backend, .backend = Backend::reference};
    viewer.advance(1);
    ASSERT_TRUE(viewer.beside()) << viewer.message().text;
    for (int f = 0; f < 20; ++f) viewer.advance(1);
    const Image both = viewer.image();
    ASSERT_EQ(both.width, 320);
    Image halves[2];
    for (int h = 0; h < 2; ++h) {
        halves[h] = {160, 240, {}};
        for (int y = 0; y < 240; ++y) {
            const auto from = both.pixels.begin() + 4 * (320 * y + 160 * h);
            halves[h].pixels.insert(halves[h].pixels.end(), from, from + 4 * 160);
        }
    }
    EXPECT_TRUE(difference(halves[0], halves[1]) < 0.1) << difference(halves[0], halves[1]);
    viewer.options.compared = {};
    viewer.advance(1);
    EXPECT_FALSE(viewer.beside());
}

TEST_F(ViewerTest, AnotherComparisonIsShownAnew) {
    open("drape", {"body.1.cloth=[12,12]"});
    viewer.advance(20);
    Image seen[2];
    for (int i = 0; i < 2; ++i) {
        viewer.options.compared = {.with = Compared::With::mapping,
                                   .mapping = i == 0 ? Mapping::frames : Mapping::one_to_one};
        viewer.advance(0);
        ASSERT_TRUE(viewer.beside()) << viewer.message().text;
        seen[i] = viewer.image();
    }
    EXPECT_EQ(seen[0].width, seen[1].width);
    open("box");  // and of another scene nothing is left
    viewer.options.compared = {.with = Compared::With::backend, .backend = Backend::reference};
    viewer.advance(1);
    EXPECT_GT(difference(viewer.image(), seen[1]), 1);
}

TEST_F(ViewerTest, StereoShowsTwoEyes) {
    open("box");
    const Image mono = viewer.image();
    viewer.options.stereo = true;
    const Image stereo = viewer.image();
    EXPECT_EQ(stereo.width, mono.width);
    EXPECT_EQ(stereo.height, mono.height);
    EXPECT_EQ(viewer.view_size(), ivec2(160, 240));
    // The eyes see nearly the same, but not quite.
    double apart = 0;
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 4 * 160; ++x)
            apart += std::abs(int(stereo.pixels[std::size_t(4 * 320 * y + x)]) -
                              int(stereo.pixels[std::size_t(4 * 320 * y + 4 * 160 + x)]));
    apart /= 4 * 160 * 240;
    EXPECT_TRUE(apart > 0.05 && apart < 20) << apart;
}

TEST_F(ViewerTest, EveryLookShows) {
    open("box");
    const Image plain = viewer.image();
    for (bool Look3d::*look : {&Look3d::wireframe, &Look3d::springs, &Look3d::normals}) {
        viewer.options.look = {};
        viewer.options.look.*look = true;
        EXPECT_GT(difference(viewer.image(), plain), 0.3);
    }
    viewer.options.look = {};
    viewer.options.look.culling = false;
    EXPECT_EQ(difference(viewer.image(), plain), 0);
}

TEST_F(ViewerTest, OnAGpuItLooksTheSame) {
    open("box");
    viewer.advance(20);
    const Image before = viewer.image();
    viewer.change({"simulation.backend=\"compute\""});
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    EXPECT_TRUE(difference(viewer.image(), before) < 0.5) << difference(viewer.image(), before);
    viewer.advance(3);
    EXPECT_TRUE(viewer.experiment()->trouble().empty());
    viewer.move_pointer(middle());
    viewer.press(Button::left);
    EXPECT_TRUE(viewer.is_holding()) << viewer.message().text;
    viewer.change({"simulation.backend=\"cpu\""});  // while it is held
    viewer.advance(3);
    EXPECT_TRUE(viewer.is_holding());
}

// ---- what is opened and saved ----

TEST_F(ViewerTest, ABrokenFileIsSaidAndWhatWasOpenStays) {
    const Scratch scratch;
    open("box");
    write_text(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 5\n");
    write_text(scratch / "broken.toml", "[[body]\n");
    write_text(scratch / "broken.json", "{");
    write_text(scratch / "odd \"name\".obj", "v 0 0 0\n");
    const std::string name = viewer.experiment()->source().name;
    for (const char* file : {"broken.ply", "broken.toml", "broken.json", "odd \"name\".obj", "nowhere.stl"}) {
        viewer.open_file(scratch / file);
        wait_until_open(viewer);
        EXPECT_TRUE(viewer.message().bad) << file;
        EXPECT_NE(viewer.message().text.find(file), std::string::npos) << viewer.message().text;
        ASSERT_TRUE(viewer.experiment());
        EXPECT_EQ(viewer.experiment()->source().name, name);
        viewer.advance(1);
    }
}

TEST_F(ViewerTest, AMeshBecomesABodyAndCanBeCancelled) {
    const Scratch scratch;
    const Mesh ball = ellipsoid(vec3(1), 30);
    write_mesh(ball, scratch / "ball.ply");
    viewer.open_file(scratch / "ball.ply");
    viewer.cancel_import();
    wait_until_open(viewer);
    EXPECT_FALSE(viewer.experiment());
    viewer.open_file(scratch / "ball.ply");
    wait_until_open(viewer);
    ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    EXPECT_GT(viewer.experiment()->models().models[0].body.count(), 1000u);
    // It is the scene that the command runs off screen, and all of it is seen.
    EXPECT_EQ(viewer.experiment()->source().text, find_scene((scratch / "ball.ply").string()).text);
    for (vec3 p : viewer.experiment()->play().skins()[0].positions) {
        const vec2 at = *pixel_of(viewer.camera(), p, size);
        ASSERT_TRUE(at.x > 0 && at.x < float(size.x) && at.y > 0 && at.y < float(size.y));
    }
    viewer.advance(2);
    viewer.open_file(scratch / "ball.ply");  // and is destroyed while it opens another
}

TEST_F(ViewerTest, SavesWhatCanBeOpenedAgain) {
    const Scratch scratch;
    open("box", {"body.1.damping=4"});
    viewer.folder = scratch / "";
    viewer.advance(10);
    drag(middle(), middle() + vec2(10, 10), 10);
    viewer.release(Button::left);
    viewer.change({"simulation.integrator=\"rk4\""});
    viewer.advance(5);
    viewer.save_picture();
    viewer.save_surface();
    viewer.save_recording();
    const std::string print = viewer.experiment()->fingerprint();
    for (const char* file : {"box-1.png", "box-1.ply", "box-1.json"})
        EXPECT_TRUE(std::filesystem::exists(scratch / file)) << file << ": " << viewer.message().text;
    viewer.save_picture();
    EXPECT_TRUE(std::filesystem::exists(scratch / "box-2.png"));
    viewer.open_file(scratch / "box-1.json");
    const Experiment* open_before = viewer.experiment();
    while (viewer.importing()) {  // what was open goes on meanwhile, and not by the recording
        viewer.advance(1);
        EXPECT_TRUE(viewer.experiment() != open_before || !viewer.replaying());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(viewer.replaying()) << viewer.message().text;
    for (int f = 0; f < 100 && viewer.replaying(); ++f) viewer.advance(1);
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    EXPECT_EQ(viewer.experiment()->fingerprint(), print);
    EXPECT_TRUE(viewer.options.paused);
}

TEST_F(ViewerTest, WhatBlowsUpIsHeldAndReturnedFrom) {
    open("box");
    viewer.advance(40);
    const double bound = viewer.experiment()->stable_step(0);
    viewer.change({"simulation.step=" + std::to_string(1.4 * bound)});
    for (int f = 0; f < 900 && viewer.experiment()->trouble().empty(); ++f) viewer.advance(1);
    ASSERT_FALSE(viewer.experiment()->trouble().empty());
    EXPECT_TRUE(viewer.message().bad);
    viewer.advance(5);
    viewer.draw();
    viewer.undo();
    viewer.return_to_good();
    EXPECT_TRUE(viewer.experiment()->trouble().empty()) << viewer.message().text;
}

TEST_F(ViewerTest, NothingIsOpenAndAllIsAsked) {
    viewer.advance(3);
    viewer.draw();
    viewer.move_pointer(vec2(10));
    viewer.press(Button::left);
    viewer.wheel(1);
    viewer.release(Button::left);
    viewer.undo(), viewer.redo(), viewer.restart(), viewer.step_once(), viewer.return_to_good();
    viewer.save_scene(), viewer.save_picture(), viewer.save_surface(), viewer.save_recording();
    viewer.start_or_stop_film(), viewer.keep(), viewer.frame_selection();
    viewer.change({"simulation.step=1"});
    viewer.resize(ivec2(0, 0));
    EXPECT_EQ(viewer.size(), size);
    viewer.resize(ivec2(7, 5));
    viewer.draw();
}

// ---- the controls ----

class GuiTest : public ViewerTest {
 protected:
    Gui gui{1};

    // One picture of the controls, with the pointer there.
    void frame(vec2 pointer, bool down = false) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {float(size.x * 3), float(size.y * 3)};
        io.DeltaTime = 1.0f / 60;
        io.MousePos = {pointer.x, pointer.y};
        io.MouseDown[0] = down;
        ImGui_ImplOpenGL3_NewFrame();
        ImGui::NewFrame();
        gui.draw(viewer);
    }
    void click(vec2 at) { frame(at), frame(at, true), frame(at), frame(at); }
};

TEST_F(GuiTest, ClicksReachTheControls) {
    viewer.resize(3 * size);
    open("box");
    viewer.advance(2);
    for (int i = 0; i < 3; ++i) frame(vec2(900, 700));  // sizes are found over a few pictures
    EXPECT_FALSE(gui.wants_pointer());
    frame(vec2(30, 40));
    EXPECT_TRUE(gui.wants_pointer());
    EXPECT_FALSE(viewer.options.paused);
    click(vec2(25, 40));
    EXPECT_TRUE(viewer.options.paused);
    const double before = viewer.experiment()->time();
    click(vec2(90, 40));  // a frame
    EXPECT_GT(viewer.experiment()->time(), before);
    click(vec2(76, 94));
    EXPECT_EQ(viewer.options.mode, Mode::press);
}

TEST_F(GuiTest, KeysDoWhatTheHelpSays) {
    open("box");
    viewer.advance(2);
    gui.key(viewer, '3', false, false);
    EXPECT_EQ(viewer.options.mode, Mode::dent);
    gui.key(viewer, '1', false, false);
    gui.key(viewer, 'W', false, false);
    gui.key(viewer, 'L', false, false);
    gui.key(viewer, 'N', false, false);
    EXPECT_TRUE(viewer.options.look.wireframe && viewer.options.look.springs && viewer.options.look.normals);
    gui.key(viewer, ' ', false, false);
    EXPECT_TRUE(viewer.options.paused);
    gui.key(viewer, '\t', false, false);
    EXPECT_FALSE(gui.shows_panel);
    gui.key(viewer, '?', false, false);
    EXPECT_TRUE(gui.shows_help);
    frame(vec2(0));
    gui.key(viewer, Gui::escape_key, false, false);
    EXPECT_FALSE(gui.shows_help);
    viewer.change({"body.1.damping=9"});
    gui.key(viewer, 'Z', true, false);
    EXPECT_EQ(viewer.experiment()->scene().bodies[0].material.damping, 2);
    gui.key(viewer, 'Z', true, true);
    EXPECT_EQ(viewer.experiment()->scene().bodies[0].material.damping, 9);
    for (int key = 0; key < 128; ++key)  // whatever comes
        if (std::string("VPEJ").find(char(key)) == std::string::npos)
            gui.key(viewer, char(key), false, false), frame(vec2(5));
    viewer.options.paused = false;
    viewer.advance(1);
}

TEST_F(GuiTest, DrawsItselfOverThePicture) {
    viewer.resize(3 * size);
    open("drape");
    viewer.options.care = Care::full;
    viewer.advance(2);
    GLuint buffer = 0, frame_buffer = 0;
    glCreateRenderbuffers(1, &buffer);
    glNamedRenderbufferStorage(buffer, GL_RGBA8, 960, 720);
    glCreateFramebuffers(1, &frame_buffer);
    glNamedFramebufferRenderbuffer(frame_buffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    Image shown{960, 720, std::vector<std::uint8_t>(4 * 960 * 720)};
    auto show = [&](bool controls) {
        glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
        glViewport(0, 0, 960, 720);
        viewer.draw();
        glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
        if (controls) frame(vec2(-1000));
        glReadPixels(0, 0, 960, 720, GL_RGBA, GL_UNSIGNED_BYTE, shown.pixels.data());
        return shown;
    };
    const Image bare = show(false);
    for (int i = 0; i < 3; ++i) show(true);
    const Image with = show(true);
    EXPECT_GT(difference(bare, with), 5);  // the panel
    // Where no control is, the picture is the same.
    double right = 0;
    for (int y = 100; y < 500; ++y)
        for (int x = 4 * 500; x < 4 * 900; ++x)
            right += std::abs(int(bare.pixels[std::size_t(4 * 960 * y + x)]) -
                              int(with.pixels[std::size_t(4 * 960 * y + x)]));
    EXPECT_TRUE(right / (400 * 1600) < 1) << right / (400 * 1600);
    glDeleteFramebuffers(1, &frame_buffer);
    glDeleteRenderbuffers(1, &buffer);
}

}  // namespace
}  // namespace palpate
