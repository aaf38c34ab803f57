// A whole hand on a clock that goes where the test says: what it feels, what it leaves, and what becomes of
// it when something fails.
#include "palpate/touch/touch.h"

#include "palpate/base/error.h"
#include "palpate/touch/devices/faulty.h"
#include "palpate/touch/devices/scaled.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "tests/shapes.h"
#include "tests/touch/allocations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

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
    bool write(const Wrench& wrench) noexcept override {
        written = wrench.force;
        return Decorator::write(wrench);
    }
    void stop() noexcept override {
        written = vec3(0);
        ++stops;
        Decorator::stop();
    }
    vec3 written = vec3(0);
    int stops = 0;
};

// A motor that holds what it took last until it is told otherwise, as hardware does; its hand follows a path.
class Motor final : public Decorator {
 public:
    explicit Motor(Path path) : Decorator(std::make_unique<Script>(std::move(path))) {}
    DeviceSpec spec() const override { return {.name = "motor"}; }
    void open() override {
        ++opened;
        Decorator::open();
    }
    bool write(const Wrench& wrench) noexcept override {
        holds = wrench.force;
        return true;
    }
    void stop() noexcept override { holds = vec3(0); }
    vec3 holds = vec3(0);  // N
    int opened = 0;
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

// A hand that goes 2 mm into a slab, which is simulated, and at 4 s out of it; each call of `until` brings
// patches with that load, a millisecond apart.
struct OnSimulated {
    Mesh mesh = slab();
    Scene1 s;

    explicit OnSimulated(TouchSettings settings = soft(), vec3 first = {0, 0.01f, 0})
        : s(std::make_unique<Script>(path({{0, first},
                                           {1.2, first},
                                           {1.5, {0, radius - 0.002f, 0}},
                                           {4, {0, radius - 0.002f, 0}},
                                           {4.1, {0, 0.01f, 0}}})),
            std::move(settings)) {}
    void feel(dvec3 load) {
        const Touchable one[] = {{mesh.positions, mesh.triangles}};
        s.touch->feel(Patch(one, vec3(0), 1, s.time), {.surfaces = 1, .load = load});
    }
    void until(double end, dvec3 load) {
        while (s.time < end - 1e-9) {
            feel(load);
            s.tick();
        }
    }
};

TEST(Touch, OfASimulatedSurfaceItFeelsTheLoad) {
    OnSimulated on;
    on.until(1.9, {0, 0.25, 0});
    EXPECT_LE(std::abs(on.s.device->written.y - 0.25), 1e-4);
    EXPECT_EQ(on.s.touch->felt().part, 1);
    on.until(1.95, {0, 0.1, 0});
    EXPECT_LE(std::abs(on.s.device->written.y - 0.1), 1e-4);
}

// A simulation that hangs pushes nobody for long, and nobody who has left.
TEST(Touch, ALoadEndsWithItsPatchAndWithTheContact) {
    OnSimulated hangs;
    hangs.until(1.9, {0, 0.25, 0});
    hangs.s.until(1.915);
    EXPECT_GT(hangs.s.device->written.y, 0.2f);
    hangs.s.until(1.925);
    EXPECT_EQ(hangs.s.device->written, vec3(0));
    OnSimulated leaves;
    leaves.until(4.015, {0, 0.25, 0});
    leaves.s.until(4.03);
    EXPECT_EQ(leaves.s.device->written, vec3(0));
}

// Whoever is inside, since the surface has jumped over it or it begins there, presses and feels nothing until
// it has come out.
TEST(Touch, AHandThatIsInsideMustComeOutFirst) {
    OnSimulated on;
    on.until(1.9, {0, 0.25, 0});
    for (vec3& p : on.mesh.positions) p.y += 0.004f;  // a surface that jumps
    on.until(3.9, {0, 0, 0});
    EXPECT_EQ(on.s.touch->felt().part, 0);
    EXPECT_EQ(on.s.device->written, vec3(0));
    OnSimulated began(soft(), {0, radius - 0.008f, 0});
    began.until(1.1, {0, 0, 0});
    EXPECT_EQ(began.s.touch->felt().part, 0);
}

// In a corner of both, the wall that stands still pushes as it always does.
TEST(Touch, BesideASimulatedFloorAWallStillPushes) {
    const Mesh floor = slab(), wall = block(vec3(-0.2f, -0.1f, -0.1f), vec3(-0.02f, 0.1f, 0.1f), 8);
    TouchSettings settings = soft();
    settings.feels.push_back(settings.feels[0]);
    const vec3 out(-0.01f, 0.01f, 0), in(-0.02f + radius - 0.001f, radius - 0.002f, 0);
    Scene1 s(std::make_unique<Script>(path({{0, out}, {1.2, out}, {1.5, in}, {2, in}})), settings);
    const Touchable both[] = {{floor.positions, floor.triangles}, {wall.positions, wall.triangles}};
    while (s.time < 1.9) {
        s.touch->feel(Patch(both, vec3(0), 1, s.time), {.surfaces = 1, .load = {0, 0.25, 0}});
        s.tick();
    }
    EXPECT_LE(glm::distance(s.device->written, vec3(300 * 0.001f, 0.25f, 0)), 0.03f);
}

TEST(Touch, ASimulatedSurfaceKeepsNoDents) {
    TouchSettings settings = soft();
    settings.feels[0].yield = 0.0005;
    OnSimulated on(settings);
    on.until(1.9, {0, 0.25, 0});
    EXPECT_EQ(on.s.touch->felt().count, 0);
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

// ---- what the hand gives to the surface ----

// A simulation gets all the momentum that the hand got, however seldom it asks, also while a force fades
// after the hand has gone: to rounding the integral of what was written.
TEST(Touch, WhatTheHandGetsTheSurfaceGetsBack) {
    const Mesh mesh = slab();
    for (int every : {1, 17, 100'000}) {
        Scene1 s(std::make_unique<VirtualHand>(path({{0, {0.01f, 0.02f, 0}},
                                                     {1.2, {0.01f, 0.01f, 0}},
                                                     {1.8, {0.01f, radius - 0.01f, 0.02f}},
                                                     {3, {-0.03f, radius - 0.006f, 0.02f}},
                                                     {3.05, {-0.03f, 0.05f, 0.02f}}})),
                 soft());
        s.touch->feel(all_of(mesh));
        dvec3 given(0), got(0);
        double size = 0, last = 0;
        long count = 0;
        auto take_all = [&] {
            for (Push push; s.touch->next(push); ++count) {
                got += push.impulse;
                EXPECT_EQ(push.surface, 0);
                ASSERT_LT(std::size_t(push.triangle), mesh.triangles.size());
                EXPECT_NEAR(push.weights.x + push.weights.y + push.weights.z, 1, 1e-9);
                EXPECT_GT(push.time, last);
                last = push.time;
                const uvec3 t = mesh.triangles[std::size_t(push.triangle)];
                EXPECT_NEAR(glm::dot(push.weights, dvec3(mesh.positions[t.x].y, mesh.positions[t.y].y,
                                                         mesh.positions[t.z].y)),
                            0, 1e-6);
            }
        };
        const std::size_t before = allocations();
        for (int i = 0; i < 4000; ++i) {
            const dvec3 holds(s.device->written);
            const double seconds = (i % 3 + 0.5) * 1e-3;
            s.time += seconds;
            s.touch->tick(s.time);
            given += seconds * holds;
            size += seconds * glm::length(holds);
            if (i % every == every - 1) take_all();
        }
        EXPECT_EQ(allocations(), before);
        EXPECT_EQ(s.device->written, vec3(0));
        take_all();
        for (int i = 0; i < 10; ++i) s.tick(), take_all();  // what found no room
        EXPECT_GT(size, 1);
        EXPECT_LE(glm::distance(got, -given), 1e-12 * size) << every;
        EXPECT_GE(count, every < 100 ? 1000 : 256);
    }
}

// For the thread sanitizer too.
TEST(Touch, AnotherThreadTakesThePushes) {
    PushQueue pushes(2);
    constexpr int all = 100'000;
    std::atomic<bool> over = false;
    std::thread loop([&] {
        for (int i = 1; i <= all; ++i) {
            pushes.add({.surface = i % 2, .impulse = dvec3(1, i, 0), .time = double(i)});
            pushes.send();
        }
        for (; !over; std::this_thread::yield()) pushes.send();
    });
    dvec3 sum(0);
    double last[2] = {};
    Push push;
    while (sum.x < all) {
        if (!pushes.next(push)) {
            std::this_thread::yield();
            continue;
        }
        sum += push.impulse;
        EXPECT_GT(push.time, last[push.surface]);
        last[push.surface] = push.time;
    }
    over = true;
    loop.join();
    EXPECT_EQ(sum, dvec3(all, all * (all + 1.0) / 2, 0));
}

// ---- faults ----

struct Trial {
    std::string name;
    Fault fault;
    Held reason;
    bool pushes_after;  // whether it pushes again by itself in the end
};

// What counts is what the motor holds, and not what it was asked for.
TEST(Touch, ADeviceThatRefusesForcesHoldsNone) {
    const Mesh mesh = slab();
    const vec3 above(0, 0.01f, 0), deep(0, radius - 0.005f, 0);
    auto inner = std::make_unique<Motor>(
        path({{0, above}, {1.2, above}, {1.6, deep}, {6, deep}, {6.5, above}, {7, above}, {7.5, deep}}));
    const Motor& motor = *inner;
    constexpr double fails = 2, over = 5;
    Scene1 s(std::make_unique<Faulty>(std::move(inner), std::vector{Fault{FaultKind::refuse, fails, over}},
                                      [](double) {}),
             soft());
    s.touch->feel(all_of(mesh));
    s.until(fails);
    EXPECT_GE(motor.holds.y, 1.4f);
    s.tick();
    s.tick();
    while (s.time < 5.5) {  // and while the hand is still in the surface
        s.tick();
        ASSERT_EQ(motor.holds, vec3(0)) << s.time;
    }
    EXPECT_EQ(s.touch->felt().last_reason, Held::gone);
    EXPECT_EQ(s.touch->felt().force, vec3(0));
    s.until(9);
    EXPECT_GE(motor.holds.y, 1.4f);
}

// One that does not say any more where the hand is, but would hold on to its force.
TEST(Touch, ADeviceThatDoesNotAnswerHoldsNoForce) {
    class Mute final : public Decorator {
     public:
        using Decorator::Decorator;
        bool read(double now, DeviceState& state) noexcept override {
            return !mute && Decorator::read(now, state);
        }
        bool mute = false;
    };
    const Mesh mesh = slab();
    auto inner = std::make_unique<Motor>(
        path({{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}, {1.6, {0, radius - 0.005f, 0}}}));
    const Motor& motor = *inner;
    auto outer = std::make_unique<Mute>(std::move(inner));
    Mute& mute = *outer;
    Scene1 s(std::move(outer), soft());
    s.touch->feel(all_of(mesh));
    s.until(2);
    EXPECT_GE(motor.holds.y, 1.4f);
    mute.mute = true;
    s.tick();
    EXPECT_EQ(motor.holds, vec3(0));
}

// The limits are the device's, however its scale is set: half of its stiffest wall, and what its motors
// stand.
TEST(Touch, NoScaleTakesADevicePastItsLimits) {
    const Mesh mesh = slab();
    const struct {
        Scale first, then;
    } trials[] = {
        {{.motion = 1}, {.motion = 1, .forces = 3}},
        {{.motion = 1}, {.motion = 3, .forces = 1}},
        {{.motion = 1}, {.motion = 0.2f}},
        {{.motion = 2}, {.motion = 4, .forces = 4}},
        {{.motion = 1, .forces = 1}, {.motion = 1, .forces = 0.1f}},
    };
    for (const auto& trial : trials) {
        const float m = trial.then.motion;  // the hand goes as far in the scene
        const float out = 0.01f / m, in = (radius - 0.008f) / m, in_more = (radius - 0.0085f) / m;
        auto inner = std::make_unique<Motor>(path({{0, {0, out, 0}},
                                                   {2.5, {0, out, 0}},
                                                   {3, {0, in, 0}},
                                                   {3.5, {0, in, 0}},
                                                   {3.6, {0, in_more, 0}},
                                                   {40, {0, in_more, 0}}}));
        const Motor& motor = *inner;
        auto scaled = std::make_unique<Scaled>(std::move(inner), trial.first);
        Scaled& scale = *scaled;
        TouchSettings settings = soft();
        settings.feels[0] = {.stiffness = 1e5, .damping = 0, .dent_width = 0.1};
        settings.safety.peak_force = 1e9;
        Touch touch(std::move(scaled), settings);
        touch.feel(all_of(mesh));
        double square = 0, first = 0;
        long count = 0;
        const DeviceSpec spec = motor.spec();
        for (int i = 1; i < 40'000; ++i) {
            if (i == 1000) scale.set(trial.then);
            touch.tick(i * 1e-3);
            const double holds = glm::length(motor.holds);
            ASSERT_LE(holds, spec.peak_force * 1.0001f);
            if (i == 3499) first = holds;
            if (i == 3700) {  // N more over m more, at the device
                const double stiffness = (holds - first) / double(in - in_more);
                EXPECT_LE(stiffness, 0.5 * double(spec.stiffness) * 1.001);
            }
            if (i >= 20'000) square += holds * holds, ++count;
        }
        EXPECT_LE(std::sqrt(square / double(count)), 1.01 * double(spec.lasting_force));
        EXPECT_GT(square, 0);
    }
}

TEST(Touch, ASlowLoopFeelsSofterWalls) {
    const Mesh mesh = slab();
    double forces[2];
    for (int slow = 0; slow < 2; ++slow) {
        TouchSettings settings = soft();
        settings.feels[0].stiffness = 1e5;
        Scene1 s(std::make_unique<Script>(
                     path({{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}, {1.6, {0, radius - 0.002f, 0}}})),
                 settings);
        if (slow) s.touch->expect_rate(250);
        s.touch->feel(all_of(mesh));
        s.until(3);
        forces[slow] = glm::length(s.device->written);
    }
    EXPECT_NEAR(forces[0], 500 * 0.002, 0.01);
    EXPECT_NEAR(forces[1], 125 * 0.002, 0.01);
}

// ---- other settings, and beginning anew ----

TEST(Touch, OtherSettingsLeaveTheDeviceOpenAndItsMotorsWarm) {
    const Mesh mesh = slab();
    const vec3 above(0, 0.01f, 0);
    auto inner = std::make_unique<Motor>(path({{0, above}, {1.2, above}, {1.6, {0, radius - 0.02f, 0}}}));
    const Motor& motor = *inner;
    Scene1 s(std::move(inner), soft());
    s.touch->feel(all_of(mesh));
    s.until(30);
    const double lasting = s.touch->device().lasting_force;
    EXPECT_LE(glm::length(motor.holds), 1.05f * float(lasting));
    const double warm = s.touch->felt().warmth.square;
    EXPECT_GE(warm, 0.7 * lasting * lasting);
    TouchSettings other = soft();
    other.feels[0].stiffness = 200;
    other.radius = 0.0031;
    s.touch->set(other);
    s.tick();
    EXPECT_NEAR(s.touch->felt().warmth.square, warm, 0.01);
    const std::size_t before = allocations();
    s.tick();
    EXPECT_EQ(allocations(), before);
    s.until(31);
    EXPECT_LE(glm::length(motor.holds), 1.05f * float(lasting));
    EXPECT_EQ(motor.opened, 1);
    // What cannot be changes nothing.
    other.radius = NAN;
    EXPECT_THROW(s.touch->set(other), Error);
    other = soft();
    other.feels.push_back({});
    EXPECT_THROW(s.touch->set(other), Error);
    EXPECT_EQ(s.touch->settings().feels[0].stiffness, 200);
}

// Two strokes, each of which leaves a dent.
struct TwoStrokes {
    Mesh mesh = slab();
    std::unique_ptr<Scene1> scene;
    TwoStrokes() {
        TouchSettings settings = soft();
        settings.feels[0].yield = 0.002;
        const vec3 left(-0.05f, 0.01f, 0), right(0.05f, 0.01f, 0), down(0, -0.01f - 0.005f + radius, 0);
        scene = std::make_unique<Scene1>(std::make_unique<Script>(path({{0, left},
                                                                        {1.5, left},
                                                                        {2, left + down},
                                                                        {2.5, left},
                                                                        {3, right},
                                                                        {3.5, right + down},
                                                                        {4, right},
                                                                        {4.5, right + down}})),
                                         settings);
        scene->touch->feel(all_of(mesh));
        EXPECT_EQ(scene->touch->begin_stroke(), 1);
        scene->until(2.7);
        EXPECT_EQ(scene->touch->begin_stroke(), 2);
        scene->until(4);
    }
};

TEST(Touch, AStrokeIsTakenBack) {
    TwoStrokes two;
    Scene1& s = *two.scene;
    Felt felt = s.touch->felt();
    ASSERT_EQ(felt.lasting, 2);
    EXPECT_EQ(felt.last_stroke, 2);
    const Dent first = felt.dents[0];
    s.touch->forget(2);
    s.tick();
    felt = s.touch->felt();
    ASSERT_EQ(felt.lasting, 1);
    EXPECT_EQ(felt.last_stroke, 1);
    EXPECT_EQ(felt.dents[0].centre, first.centre);
    EXPECT_EQ(felt.dents[0].depth, first.depth);
    s.until(4.5);  // and is not felt any more: the full depth is
    EXPECT_LE(std::abs(glm::length(s.device->written) - 300 * 0.002f), 0.1f);
}

TEST(Touch, BeginningAnewLeavesNoDentAndNoForce) {
    TwoStrokes two;
    Scene1& s = *two.scene;
    s.until(4.499);
    EXPECT_GT(s.device->written.y, 0.4f);
    s.touch->begin_anew();
    for (int i = 0; i < 100; ++i) {
        s.tick();
        EXPECT_EQ(s.device->written, vec3(0));
        EXPECT_EQ(s.touch->felt().lasting, 0);
    }
    EXPECT_EQ(s.touch->felt().last_reason, Held::placed);
}

// However deep a hand goes, and however often it comes over the same place.
TEST(Touch, DentsAreNoDeeperThanASurfaceBears) {
    const Mesh mesh = slab(20);
    TouchSettings settings = soft();
    settings.radius = 0.002;
    settings.feels[0] = {.stiffness = 20, .friction = {0, 0}, .dent_width = 0.01, .yield = 0.001};
    std::vector<std::pair<double, vec3>> way{{0, {0, 0.01f, 0}}, {1.2, {0, 0.01f, 0}}};
    for (int i = 0; i < 30; ++i)
        way.emplace_back(1.5 + 0.4 * i,
                         vec3(0.02f * std::sin(float(i) * 1.7f), -0.045f, 0.02f * std::cos(float(i) * 2.9f)));
    Scene1 s(std::make_unique<Script>(path(way)), settings);
    s.touch->feel(all_of(mesh));
    float deepest = 0;
    while (s.time < 13) {
        s.until(s.time + 0.1);
        const Felt felt = s.touch->felt();
        const std::vector<Dent> dents(felt.dents.begin(), felt.dents.begin() + felt.lasting);
        for (float x = -0.04f; x < 0.04f; x += 0.004f)
            for (float z = -0.04f; z < 0.04f; z += 0.004f)
                deepest = std::max(deepest, depth_at(dents, vec3(x, 0, z), vec3(0, 1, 0)));
    }
    EXPECT_GT(s.touch->felt().lasting, 5);
    EXPECT_GT(deepest, 0.007f);
    EXPECT_LE(deepest, 0.0125f);  // between their centres a little more than at them
}

// ---- sheets ----

// A leaf of cloth at y = 0 that looks up.
TEST(Touch, ASheetIsFeltAndDentedFromBothSides) {
    const std::vector<vec3> corners = {{-0.1f, 0, 0.1f}, {0.1f, 0, 0.1f}, {0, 0, -0.1f}};
    const std::vector<uvec3> triangles = {{0, 1, 2}};
    for (float side : {1.0f, -1.0f})
        for (bool is_sheet : {true, false}) {
            const Touchable leaf[] = {{corners, triangles, {}, is_sheet}};
            TouchSettings settings = soft();
            settings.feels[0].yield = 0.002;
            const vec3 off(0, side * 0.01f, 0), in(0, side * (radius - 0.005f), 0);
            Scene1 s(std::make_unique<Script>(
                         path({{0, off}, {1.5, off}, {2, in}, {2.5, in}, {3, off}, {3.5, off}, {4, in}})),
                     settings);
            s.touch->feel(Patch(leaf));
            s.until(2.4);
            if (side < 0 && !is_sheet) {
                EXPECT_EQ(s.device->written, vec3(0));  // a solid's inside
                continue;
            }
            EXPECT_NEAR(s.device->written.y, side * 300 * 0.002f, 0.01f);
            s.until(3.4);
            const Felt felt = s.touch->felt();
            ASSERT_EQ(felt.lasting, 1);
            // As the renderer has it: the surface moves away from the hand, against its own normal or along
            // it.
            const vec3 there = dented({felt.dents.data(), 1}, vec3(0), vec3(0, 1, 0));
            EXPECT_NEAR(there.y, -side * 0.003f, 1e-5);
            s.until(4);
            EXPECT_NEAR(s.device->written.y, side * 300 * 0.002f, 0.01f);
        }
}

// ---- more faults ----

// A hand that is being pushed with about 1.5 N when something fails for 50 ms.
TEST(Touch, WhateverFailsTheForceIsWithinItsLimitsAndGoneIn25Milliseconds) {
    const Mesh mesh = slab();
    constexpr double fails = 2.0, over = 2.05;
    const Trial trials[] = {
        {"not a number", {FaultKind::not_a_number, fails, over}, Held::not_finite, true},
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
        EXPECT_EQ(s.device->written, vec3(0)) << trial.name;
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
    EXPECT_THROW(made({.safety = {.slew_time = 0}}), Error);
    EXPECT_THROW(made({}, {.peak_force = NAN}), Error);
    EXPECT_THROW(made({}, {.lasting_force = 0}), Error);
    EXPECT_THROW(made({}, {.stiffness = NAN}), Error);
    EXPECT_THROW(made({.feels = {{.yield = NAN}}}), Error);
    EXPECT_THROW(made({.surprise = INFINITY}), Error);
    EXPECT_THROW(made({.velocity_filter = NAN}), Error);
    EXPECT_THROW(made({.direction_filter = -1}), Error);
    EXPECT_THROW(made({.safety = {.fade = INFINITY}}), Error);
    EXPECT_THROW(made({.safety = {.peak_force = NAN}}), Error);
    EXPECT_THROW(Touch(nullptr, {}), Error);
    const Mesh mesh = slab();
    const std::vector<vec3> few(3, vec3(0));
    const Touchable wrong[] = {{few, mesh.triangles}};
    EXPECT_THROW(Patch{wrong}, Error);
    const Touchable another[] = {{mesh.positions, mesh.triangles, few}};
    EXPECT_THROW(Patch{another}, Error);
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
