// A whole hand on a clock that goes where the test says: what it feels, what it leaves, and what becomes of
// it when something fails.
#include "palpate/touch/touch.h"

#include "palpate/base/error.h"
#include "palpate/touch/devices/faulty.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "tests/shapes.h"
#include "tests/touch/allocations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace palpate {
namespace {

// The top of a block, 0.2 m wide, at y = 0.
Mesh slab(int parts = 8) { return block(vec3(-0.1f, -0.05f, -0.1f), vec3(0.1f, 0, 0.1f), parts); }

Patch all_of(const Mesh& mesh) {
    const Touchable one[] = {{mesh.positions, mesh.triangles}};
    return Patch(one);
}

// Looks on at what is written to a device.
class Watched final : public Decorator {
 public:
    using Decorator::Decorator;
    bool write(vec3 force) noexcept override {
        written = force;
        return Decorator::write(force);
    }
    void stop() noexcept override {
        written = vec3(0);
        ++stops;
        Decorator::stop();
    }
    vec3 written = vec3(0);
    int stops = 0;
};

struct Scene1 {
    Watched* device;
    std::unique_ptr<Touch> touch;
    double time = 0, rate;

    Scene1(std::unique_ptr<Device> inner, TouchSettings settings, double r = 1000) : rate(r) {
        auto watched = std::make_unique<Watched>(std::move(inner));
        device = watched.get();
        touch = std::make_unique<Touch>(std::move(watched), std::move(settings));
    }
    void tick() {
        time += 1 / rate;
        touch->tick(time);
        const vec3 f = device->written;
        ASSERT_TRUE(std::isfinite(f.x + f.y + f.z));
        ASSERT_LE(glm::length(f), touch->device().peak_force * 1.0001f);
    }
    void until(double end) {
        while (time < end - 1e-9) tick();
    }
};

Path path(std::vector<std::pair<double, vec3>> points) {
    Path list;
    for (const auto& [time, place] : points) list.push_back({time, place});
    return list;
}

constexpr float radius = 0.003f;

TouchSettings soft() { return {.radius = radius, .feels = {{.stiffness = 300, .damping = 0.5}}}; }

TEST(Touch, TheForceIsTheSameAtAnyRate) {
    const Mesh mesh = slab();
    for (double rate : {500.0, 1000.0, 2000.0}) {
        Scene1 s(std::make_unique<Script>(path({{0, {0.01f, 0.05f, 0.02f}},
                                                {1.5, {0.01f, 0.01f, 0.02f}},
                                                {2, {0.01f, radius - 0.004f, 0.02f}}})),
                 soft(), rate);
        s.touch->feel(all_of(mesh));
        s.until(3);
        EXPECT_LE(glm::distance(s.device->written, vec3(0, 300 * 0.004f, 0)), 0.01f * 300 * 0.004f) << rate;
        const Felt felt = s.touch->felt();
        EXPECT_EQ(felt.held, Held::no);
        ASSERT_EQ(felt.count, 1);
        EXPECT_LE(std::abs(felt.dents[0].depth - 0.004f), 1e-6f);
        EXPECT_LE(glm::distance(felt.dents[0].centre, vec3(0.01f, 0, 0.02f)), 1e-6f);
    }
}

// A person pushes with some force, and the wall holds it: mass, spring and damper against spring and damper.
TEST(Touch, AHandComesToRestWhereItsForceIsTheWalls) {
    const Mesh mesh = slab();
    for (double rate : {500.0, 1000.0, 2000.0}) {
        const VirtualHandSettings person;
        Scene1 s(std::make_unique<VirtualHand>(
                     path({{0, {0, 0.03f, 0}}, {1.2, {0, 0.01f, 0}}, {1.8, {0, radius - 0.01f, 0}}}), person),
                 soft(), rate);
        s.touch->feel(all_of(mesh));
        s.until(4);
        // k_hand (0.01 - d) = k_wall d
        const double depth = person.stiffness * 0.01 / (person.stiffness + 300);
        EXPECT_LE(std::abs(s.device->written.y - 300 * depth), 0.01 * 300 * depth) << rate;
    }
}

TEST(Touch, AStiffWallIsNoStifferThanTheDeviceCanHold) {
    TouchSettings settings = soft();
    settings.feels[0].stiffness = 1e6;
    Scene1 s(std::make_unique<Script>(path({{0, vec3(0)}})), settings);
    EXPECT_EQ(s.touch->settings().feels[0].stiffness, 0.5 * s.touch->device().stiffness);
}

TEST(Touch, ADeepDentStaysAndIsFelt) {
    const Mesh mesh = slab();
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.002;
    const vec3 above(0, 0.01f, 0), deep(0, radius - 0.005f, 0);
    Scene1 s(std::make_unique<Script>(path(
                 {{0, above}, {1.5, above}, {2, deep}, {2.5, deep}, {3, above}, {3.5, above}, {4, deep}})),
             settings);
    s.touch->feel(all_of(mesh));
    s.until(2.4);
    // The surface gave way to three millimetres, and two of them push back.
    EXPECT_LE(std::abs(s.device->written.y - 300 * 0.002f), 0.01f);
    Felt felt = s.touch->felt();
    ASSERT_EQ(felt.lasting, 1);
    ASSERT_EQ(felt.count, 2);
    EXPECT_LE(std::abs(felt.dents[0].depth - 0.003f), 1e-5f);
    EXPECT_LE(std::abs(felt.dents[1].depth - 0.002f), 1e-5f);
    s.until(3.4);
    felt = s.touch->felt();
    EXPECT_EQ(felt.count, 1);
    EXPECT_EQ(s.device->written, vec3(0));
    s.until(4);
    EXPECT_LE(std::abs(s.device->written.y - 300 * 0.002f), 0.01f);
    EXPECT_EQ(s.touch->felt().lasting, 1);
}

// Strokes all over, so that there is no room for more dents.
TEST(Touch, NoMoreDentsStayThanThereIsRoomFor) {
    const Mesh mesh = slab();
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.001;
    settings.feels[0].dent_width = 0.002;
    std::vector<std::pair<double, vec3>> way{{0, vec3(-0.08f, 0.01f, -0.08f)}};
    for (int i = 0; i < 20; ++i)
        way.emplace_back(i + 1.0, vec3(i % 2 ? 0.08f : -0.08f, radius - 0.004f, -0.08f + 0.008f * float(i)));
    Scene1 s(std::make_unique<Script>(path(way)), settings);
    s.touch->feel(all_of(mesh));
    s.until(20);
    const Felt felt = s.touch->felt();
    EXPECT_LE(felt.count, most_dents);
    EXPECT_GE(felt.lasting, most_dents - 4);
}

TEST(Touch, ATickAllocatesNothing) {
    const Mesh mesh = slab(20);
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.001;
    Scene1 s(std::make_unique<VirtualHand>(
                 path({{0, {-0.05f, 0.02f, 0}}, {0.5, {-0.05f, -0.002f, 0}}, {3, {0.12f, -0.004f, 0.05f}}})),
             settings);
    s.touch->feel(all_of(mesh));
    s.tick();
    const std::size_t before = allocations();
    while (s.time < 3) {
        s.time += 0.001;
        s.touch->tick(s.time);
    }
    EXPECT_EQ(allocations(), before);
    EXPECT_GT(s.touch->felt().lasting, 0);  // or it would show little
}

// ---- faults ----

struct Trial {
    std::string name;
    Fault fault;
    Held reason;
    bool pushes_after;  // whether it pushes again by itself in the end
};

// A hand that is being pushed with about 1.5 N when something fails for 50 ms.
TEST(Touch, WhateverFailsTheForceIsWithinItsLimitsAndGoneIn25Milliseconds) {
    const Mesh mesh = slab();
    constexpr double fails = 2.0, over = 2.05;
    const Trial trials[] = {
        {"not a number", {FaultKind::no_number, fails, over}, Held::not_finite, true},
        {"a jump of 5 cm down", {FaultKind::jump, fails, over, vec3(0, -0.05f, 0)}, Held::jumped, true},
        {"a jump of 5 cm aside", {FaultKind::jump, fails, over, vec3(0.05f, 0, 0)}, Held::jumped, true},
        {"gone", {FaultKind::vanish, fails, over}, Held::gone, true},
        {"frozen", {FaultKind::freeze, fails, over}, Held::stale, true},
        {"refuses forces", {FaultKind::refuse, fails, over}, Held::gone, true},
    };
    for (const Trial& trial : trials) {
        const vec3 above(0, 0.01f, 0), deep(0, radius - 0.005f, 0);
        auto script = std::make_unique<Script>(path(
            {{0, above}, {1.2, above}, {1.6, deep}, {2.6, deep}, {2.9, above}, {3.2, above}, {3.5, deep}}));
        Scene1 s(std::make_unique<Faulty>(std::move(script), std::vector{trial.fault}, [](double) {}),
                 soft());
        s.touch->feel(all_of(mesh));
        s.until(fails);
        EXPECT_GE(s.device->written.y, 1.4f) << trial.name;
        s.until(fails + 0.025);
        if (trial.fault.kind != FaultKind::refuse) EXPECT_EQ(s.device->written, vec3(0)) << trial.name;
        EXPECT_EQ(s.touch->felt().last_reason, trial.reason)
            << trial.name << ": " << name_of(s.touch->felt().last_reason);
        // It waits until the hand is out, then grows anew.
        s.until(2.6);
        EXPECT_EQ(s.device->written, vec3(0)) << trial.name;
        s.until(3.45);
        EXPECT_EQ(s.touch->felt().held, Held::ramping) << trial.name;
        s.until(5);
        EXPECT_EQ(s.touch->felt().held, Held::no) << trial.name;
        EXPECT_GE(s.device->written.y, 1.4f) << trial.name;
    }
}

// read() hangs in the device; the watchdog, whose clock goes on, stops it, and the force that was being
// reckoned is not written afterwards.
TEST(Touch, AStalledLoopIsStoppedWithinTenMilliseconds) {
    const Mesh mesh = slab();
    const vec3 deep(0, radius - 0.005f, 0);
    Scene1* scene = nullptr;
    double stopped_after = -1;
    auto sleep = [&](double seconds) {
        const double from = scene->time;
        for (double t = 0; t < seconds; t += 0.0005)
            if (scene->touch->watch(from + t) && stopped_after < 0) stopped_after = t;
        scene->time += seconds;
    };
    auto script = std::make_unique<Script>(path({{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}, {1.6, deep}}));
    Scene1 s(
        std::make_unique<Faulty>(std::move(script), std::vector{Fault{FaultKind::stall, 2.0, 2.2}}, sleep),
        soft());
    scene = &s;
    s.touch->feel(all_of(mesh));
    s.until(1.999);
    EXPECT_GE(s.device->written.y, 1.4f);
    s.until(2.01);
    EXPECT_GE(stopped_after, 0);
    EXPECT_LE(stopped_after, 0.010);
    EXPECT_GE(s.device->stops, 2);  // and again as long as it lasts
    EXPECT_EQ(s.device->written, vec3(0));
    EXPECT_EQ(s.touch->felt().last_reason, Held::stalled);
}

TEST(Touch, EndsWithoutForce) {
    const Mesh mesh = slab();
    Watched* device;
    {
        Scene1 s(std::make_unique<Script>(path({{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}, {1.6, {0, 0, 0}}})),
                 soft());
        device = s.device;
        s.touch->feel(all_of(mesh));
        s.until(2);
        EXPECT_GT(device->written.y, 0);
        s.touch->let_go();
        EXPECT_EQ(device->written, vec3(0));
    }
}

// The device is stopped, and later somebody ticks again: not where it was left.
TEST(Touch, AfterItWasLetGoItBeginsAnew) {
    const Mesh mesh = slab();
    Scene1 s(std::make_unique<Script>(
                 path({{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}, {1.6, {0, radius - 0.005f, 0}}})),
             soft());
    s.touch->feel(all_of(mesh));
    s.until(2);
    EXPECT_GE(s.device->written.y, 1.4f);
    s.touch->let_go();
    for (int i = 0; i < 100; ++i) {
        s.tick();
        EXPECT_EQ(s.device->written, vec3(0));
    }
}

TEST(Touch, ASurfaceThatAppearsInTheTipPushesNobody) {
    const Mesh mesh = slab();
    Scene1 s(std::make_unique<Script>(path({{0, {0, 0.0005f, 0}}})), soft());
    s.until(2);
    EXPECT_EQ(s.touch->felt().held, Held::no);
    s.touch->feel(all_of(mesh));  // the tip's middle is just above it
    for (int i = 0; i < 500; ++i) {
        s.tick();
        EXPECT_EQ(s.device->written, vec3(0));
    }
    EXPECT_EQ(s.touch->felt().last_reason, Held::pushed);
}

TEST(Touch, RefusesMoreSurfacesThanItHasAFeelFor) {
    const Mesh mesh = slab();
    Scene1 s(std::make_unique<Script>(path({{0, vec3(0)}})), soft());
    const Touchable two[] = {{mesh.positions, mesh.triangles}, {mesh.positions, mesh.triangles}};
    EXPECT_THROW(s.touch->feel(Patch(two)), Error);
}

TEST(Touch, RefusesSettingsThatAreNone) {
    auto made = [](TouchSettings settings, DeviceSpec spec = {}) {
        struct Said final : Decorator {
            Said(std::unique_ptr<Device> inner, DeviceSpec s)
                : Decorator(std::move(inner)), said(std::move(s)) {}
            DeviceSpec spec() const override { return said; }
            DeviceSpec said;
        };
        Touch(std::make_unique<Said>(std::make_unique<Script>(path({{0, vec3(0)}})), spec),
              std::move(settings));
    };
    EXPECT_NO_THROW(made({}));
    EXPECT_THROW(made({.radius = 0}), Error);
    EXPECT_THROW(made({.radius = NAN}), Error);
    EXPECT_THROW(made({.feels = {{.stiffness = NAN}}}), Error);
    EXPECT_THROW(made({.feels = {{.friction = {-1, 0}}}}), Error);
    EXPECT_THROW(made({.safety = {.fall = 0}}), Error);
    EXPECT_THROW(made({}, {.peak_force = NAN}), Error);
    EXPECT_THROW(made({}, {.lasting_force = 0}), Error);
}

TEST(Touch, WhatNoHandFeltLeavesNoDent) {
    const Mesh mesh = slab();
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.002;
    const Fault jump{FaultKind::jump, 2.0, 2.2, vec3(0, -0.05f, 0)};
    Scene1 s(std::make_unique<Faulty>(std::make_unique<Script>(path({{0, {0, 0.006f, 0}}})),
                                      std::vector{jump}, [](double) {}),
             settings);
    s.touch->feel(all_of(mesh));
    s.until(3);
    EXPECT_EQ(s.touch->felt().lasting, 0);
}

// In an inner edge each wall has dents of its own, and none runs away.
TEST(Touch, DentsInAnEdgeDoNotRunAway) {
    Mesh mesh;
    mesh.positions = {{0, 0, -0.1f},   {0, 0, 0.1f},     {0.1f, 0, -0.1f},
                      {0.1f, 0, 0.1f}, {0, 0.1f, -0.1f}, {0, 0.1f, 0.1f}};
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.001;
    Scene1 s(std::make_unique<Script>(
                 path({{0, {0.02f, 0.02f, 0}}, {1.2, {0.02f, 0.02f, 0}}, {2, {-0.002f, -0.002f, 0}}})),
             settings);
    s.touch->feel(all_of(mesh));
    s.until(4);
    const Felt felt = s.touch->felt();
    EXPECT_GT(felt.lasting, 0);
    for (int i = 0; i < felt.count; ++i) EXPECT_LE(felt.dents[std::size_t(i)].depth, 0.006f);
}

}  // namespace
}  // namespace palpate
