// What stands between a wish and a hand: on a clock that goes where the test says.
#include "palpate/touch/safety.h"

#include "palpate/base/error.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Clocked {
    DeviceSpec device;
    SafetySettings settings;
    double rate = 1000, time = 0;
    DeviceState state = {};
    Safety safety{device, settings};
    vec3 force = vec3(0);
    double sharpest = 0;  // N/s

    explicit Clocked(double r = 1000, SafetySettings s = {}) : settings(s), rate(r), safety(device, s) {}

    vec3 tick(vec3 wanted, bool fresh = true, dvec3 velocity = dvec3(0)) {
        time += 1 / rate;
        if (fresh) state.time = time;
        const vec3 before = force;
        force = safety.allow({wanted}, state, velocity, dvec3(0), time).force;
        EXPECT_TRUE(std::isfinite(force.x + force.y + force.z));
        EXPECT_LE(glm::length(force), safety.peak_force() * (1 + 1e-6));
        sharpest = std::max(sharpest, double(glm::distance(force, before)) * rate);
        return force;
    }
    void arm() {
        for (int i = 0; i < int(1.2 * rate); ++i) tick(vec3(0));
        EXPECT_EQ(safety.held(), Held::no);
    }
    // How long it takes from now on until there is no force, s.
    template <class Tick>
    double until_nothing(const Tick& some) {
        const double start = time;
        for (int i = 0; i < rate; ++i) {
            some();
            if (force == vec3(0)) return time - start;
        }
        return 1;
    }
};

TEST(Safety, BeginsWithNothingUntilLittleIsWantedAndGrowsInASecond) {
    for (double rate : {250.0, 1000.0, 4000.0}) {
        Clocked c(rate);
        for (int i = 0; i < rate; ++i) EXPECT_EQ(c.tick(vec3(0, 0.5f, 0)), vec3(0));
        EXPECT_EQ(c.safety.held(), Held::waiting);
        for (int i = 0; i <= 0.02 * rate; ++i) EXPECT_LE(c.tick(vec3(0, 0.05f, 0)).y, 0.001);
        const double begin = c.time;
        while (c.time < begin + 2) {
            c.tick(vec3(0, 0.5f, 0));
            const double right = 0.5 * std::min(c.time - begin, 1.0);
            EXPECT_LE(std::abs(c.force.y - right), 0.01);
        }
        EXPECT_EQ(c.safety.held(), Held::no);
        EXPECT_EQ(c.force, vec3(0, 0.5f, 0));
    }
}

TEST(Safety, LimitsKeepTheDirectionAndTheRateOfChange) {
    std::mt19937 random(1);
    std::normal_distribution<float> any;
    Clocked c;
    c.arm();
    const vec3 way = glm::normalize(vec3(1, -2, 0.5f));
    for (int i = 0; i < 20; ++i) c.tick(50.0f * way);
    EXPECT_LE(glm::distance(c.force, float(c.safety.peak_force()) * way), 1e-6);
    for (int i = 0; i < 5000; ++i) c.tick(10.0f * vec3(any(random), any(random), any(random)));
    EXPECT_LE(c.sharpest, c.safety.peak_force() / c.settings.slew_time * (1 + 1e-5));
}

TEST(Safety, HoldsTheMeanSquareToWhatTheDeviceCanStand) {
    Clocked c;
    c.arm();
    double square = 0;
    const int long_time = 60'000;
    for (int i = 0; i < long_time; ++i) {
        const double f = glm::length(c.tick(vec3(0, 0, 3.3f)));
        if (i >= long_time / 2) square += f * f;
    }
    const double lasting = c.device.lasting_force;
    EXPECT_LE(std::sqrt(square / (long_time / 2)), 1.01 * lasting);
    EXPECT_LE(0.9 * lasting, glm::length(c.force));
    // A small one goes on as long as one likes.
    Clocked small;
    small.arm();
    for (int i = 0; i < 30'000; ++i) small.tick(vec3(0, 0.7f, 0));
    EXPECT_EQ(small.force, vec3(0, 0.7f, 0));
}

TEST(Safety, WhatIsNotANumberIsNothing) {
    for (int what = 0; what < 4; ++what) {
        Clocked c;
        c.arm();
        for (int i = 0; i < 20; ++i) c.tick(vec3(0, 2, 0));
        EXPECT_EQ(c.force, vec3(0, 2, 0));
        const double zero = c.until_nothing([&] {
            if (what == 0) c.tick(vec3(NAN, 0, 0));
            if (what == 1) c.tick(vec3(0, INFINITY, 0));
            c.state.pose.place = what == 2 ? dvec3(0, NAN, 0) : dvec3(0);
            if (what == 2) c.tick(vec3(0, 2, 0));
            if (what == 3) {
                c.time += 0.001;
                c.state.time = nan;
                c.force = c.safety.allow({vec3(0, 2, 0)}, c.state, dvec3(0), dvec3(0), c.time).force;
            }
        });
        EXPECT_LE(zero, 0.025) << what;
        EXPECT_EQ(c.safety.last_reason(), Held::not_finite) << what;
        c.state.pose.place = dvec3(0);
        c.state.time = c.time;
        // It comes back by a new ramp, and only once little is wanted.
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(vec3(0, 2, 0)), vec3(0));
        c.tick(vec3(0));  // a moment is not enough
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(vec3(0, 2, 0)), vec3(0));
        for (int i = 0; i < 21; ++i) c.tick(vec3(0));
        EXPECT_EQ(c.safety.held(), Held::ramping);
        for (int i = 0; i < 500; ++i) c.tick(vec3(0, 2, 0));
        EXPECT_LE(std::abs(c.force.y - 1), 0.02);
    }
}

TEST(Safety, OldSamplesFadeInTwentyMilliseconds) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(vec3(0, 1, 0));
    const double start = c.state.time;
    double last = 1;
    while (c.time < start + 0.03) {
        c.tick(vec3(0, 1, 0), false);
        EXPECT_LE(c.force.y, last + 1e-12);
        if (c.time - start <= 0.003 - 1e-9) EXPECT_EQ(c.force.y, 1);
        if (c.time - start >= 0.0231) EXPECT_EQ(c.force.y, 0);
        last = c.force.y;
    }
    EXPECT_EQ(c.safety.last_reason(), Held::stale);
}

TEST(Safety, AHandThatJumpsIsLetGoOf) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(vec3(0, 1, 0));
    c.state.pose.place.x += 0.05;
    const double zero = c.until_nothing([&] { c.tick(vec3(0, 20, 0)); });
    EXPECT_LE(zero, 0.025);
    EXPECT_EQ(c.safety.last_reason(), Held::jumped);
    // One that is moved fast is not.
    Clocked fast;
    fast.arm();
    for (int i = 0; i < 300; ++i) {
        fast.state.pose.place.x += 0.002;
        fast.tick(vec3(0));
    }
    EXPECT_EQ(fast.safety.held(), Held::no);
}

TEST(Safety, WhatIsSetAnewRampsAnew) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(vec3(0, 1, 0));
    ++c.state.placed;
    c.tick(vec3(0, 1, 0));
    EXPECT_EQ(c.safety.held(), Held::placed);
    EXPECT_LE(c.until_nothing([&] { c.tick(vec3(0, 1, 0)); }), 0.025);
}

// A wall whose spring pushes late gives energy out; with the observer a free hand does not gain any.
TEST(Safety, APassiveWallGivesNoEnergyOut) {
    for (bool observed : {false, true}) {
        SafetySettings settings;
        settings.ramp = 0;
        settings.small_force = 1e9;
        settings.calm = 0;
        settings.slew_time = 1e-6;
        settings.most_damping = observed ? 50 : 0;
        Clocked c(1000, settings);
        const double mass = 0.1, stiffness = 1000, dt = 0.001;
        double x = 0.01, v = -0.05;  // m, m/s; the wall is at 0
        std::array<double, 4> late = {};
        double fastest_out = 0;
        for (int i = 0; i < 2000; ++i) {
            std::rotate(late.begin(), late.begin() + 1, late.end());
            late.back() = x < 0 ? -stiffness * x : 0;
            c.state.pose.place = dvec3(0, x, 0);
            const dvec3 f(c.tick(vec3(0, float(late.front()), 0), true, dvec3(0, v, 0)));
            v += f.y / mass * dt;
            x += v * dt;
            fastest_out = std::max(fastest_out, v);
        }
        if (observed)
            EXPECT_LE(fastest_out, 0.05 * 1.02);
        else
            EXPECT_GE(fastest_out, 0.05 * 1.1);  // else the test shows nothing
    }
}

TEST(Safety, AClockThatStopsOrTurnsBackLetsGo) {
    for (double step : {0.1, -0.5, 1e9}) {
        Clocked c;
        c.arm();
        for (int i = 0; i < 30; ++i) c.tick(vec3(0, 1, 0));
        c.time += step;
        c.state.time = c.time;
        EXPECT_EQ(c.safety.allow({vec3(0, 1, 0)}, c.state, dvec3(0), dvec3(0), c.time), Wrench{});
        EXPECT_EQ(c.safety.last_reason(), Held::stalled);
        c.force = vec3(0);
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(vec3(0, 1, 0)), vec3(0));
    }
}

TEST(Safety, ASampleFromTheFutureIsNoBetterThanAnOldOne) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(vec3(0, 1, 0));
    c.state.time = 1e6;
    EXPECT_LE(c.until_nothing([&] { c.tick(vec3(0, 1, 0), false); }), 0.025);
    EXPECT_EQ(c.safety.last_reason(), Held::stale);
}

// None of them may switch a limit off.
TEST(Safety, EachSettingIsChecked) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    double SafetySettings::*const all[] = {
        &SafetySettings::peak_force,   &SafetySettings::lasting_force, &SafetySettings::warm_up,
        &SafetySettings::slew_time,    &SafetySettings::small_force,   &SafetySettings::calm,
        &SafetySettings::ramp,         &SafetySettings::fresh,         &SafetySettings::fade,
        &SafetySettings::fastest_hand, &SafetySettings::jump,          &SafetySettings::lost,
        &SafetySettings::store,        &SafetySettings::most_damping};
    static_assert(sizeof all / sizeof all[0] * sizeof(double) == sizeof(SafetySettings));
    for (auto one : all)
        for (double value : {nan, inf, -inf, -1.0}) {
            SafetySettings settings;
            settings.*one = value;
            EXPECT_THROW(Safety({}, settings), Error) << (one == all[8]) << value;
        }
    // A force would go on for longer than anybody holds on to a device.
    for (auto one : {&SafetySettings::slew_time, &SafetySettings::fresh, &SafetySettings::fade,
                     &SafetySettings::lost, &SafetySettings::jump})
        for (double value : {1e300, 1.01}) {
            SafetySettings settings;
            settings.*one = value;
            EXPECT_THROW(Safety({}, settings), Error) << value;
        }
    EXPECT_EQ(refusal([] { Safety({.name = "an arm"}, {.fade = inf}); }),
              "SafetySettings::fade is inf in an arm; give it above zero, and 1 at most");
    for (float value : {float(nan), float(inf), 0.0f, -1.0f}) {
        EXPECT_THROW(Safety({.peak_force = value}, {}), Error);
        EXPECT_THROW(Safety({.lasting_force = value}, {}), Error);
        EXPECT_THROW(Safety({.stiffness = value}, {}), Error);
    }
    EXPECT_THROW(Safety({}, {}, {.square = nan}), Error);
}

// A motor that pushed until a moment ago is as warm for whoever takes it over, and has cooled down later.
TEST(Safety, WarmMotorsStayWarm) {
    Clocked first;
    first.arm();
    for (int i = 0; i < 30'000; ++i) first.tick(dvec3(0, 0, 3.3f));
    const Warmth warmth = first.safety.warmth();
    EXPECT_NEAR(warmth.square, 0.9 * 0.9, 0.05);
    for (double later : {0.001, 60.0}) {
        SafetySettings settings;
        settings.calm = settings.ramp = 0;
        Safety second({}, settings, warmth);
        vec3 force(0);
        for (int i = 0; i < 50; ++i) {
            const double now = warmth.time + later + i * 1e-3;
            const DeviceState state{.time = now};
            force = second.allow({vec3(0, 0, i < 3 ? 0 : 3.3f)}, state, dvec3(0), dvec3(0), now).force;
        }
        if (later < 1)
            EXPECT_LE(glm::length(force), 1.2);
        else
            EXPECT_NEAR(glm::length(force), 3.3, 1e-6);
    }
}

// A torque hurts as a force does, and has the same limits: here of 0.4 N·m for a moment and 0.1 for long.
TEST(Safety, TorquesAreBoundedAsForcesAre) {
    const DeviceSpec device{.peak_torque = 0.4f, .lasting_torque = 0.1f};
    const SafetySettings settings;
    Safety safety(device, settings);
    double time = 0, square = 0;
    Wrench last;
    auto tick = [&](const Wrench& wanted) {
        time += 1e-3;
        const Wrench now = safety.allow(wanted, {.time = time}, dvec3(0), dvec3(0), time);
        EXPECT_LE(glm::length(now.torque), 0.4f * (1 + 1e-6f));
        EXPECT_LE(glm::distance(now.torque, last.torque), 0.4f / 8 * (1 + 1e-5f));
        return last = now;
    };
    // As a force, it begins when little is wanted, and grows in a second.
    for (int i = 0; i < 100; ++i) EXPECT_EQ(tick({vec3(0), vec3(0.3f, 0, 0)}), Wrench{});
    for (int i = 0; i < 21; ++i) tick({});
    for (int i = 0; i < 500; ++i) tick({vec3(1, 0, 0), vec3(0.1f, 0, 0)});
    EXPECT_NEAR(last.force.x, 0.5f, 0.01f);
    EXPECT_NEAR(last.torque.x, 0.05f, 0.001f);
    for (int i = 0; i < 100; ++i) tick({vec3(0), vec3(0, 7, 0)});
    EXPECT_NEAR(last.torque.y, 0.4f, 1e-6f);
    for (int i = 0; i < 60'000; ++i) {
        const float turns = glm::length(tick({vec3(0), vec3(0, 0, 7)}).torque);
        if (i >= 30'000) square += double(turns * turns) / 30'000;
    }
    EXPECT_NEAR(std::sqrt(square), 0.095, 0.006);
    EXPECT_NE(tick({vec3(0), vec3(0, 0, 7)}), Wrench{});
    for (int i = 0; i < 25; ++i) tick({vec3(0), vec3(0, NAN, 0)});
    EXPECT_EQ(last, Wrench{});
    EXPECT_EQ(safety.last_reason(), Held::not_finite);
    // A device that turns nobody is told nothing of it; half of the force is half of the torque.
    for (const auto& [spec, peak] : {std::pair{DeviceSpec{}, 0.0f}, {device, 0.2f}}) {
        SafetySettings at_once;
        at_once.calm = at_once.ramp = 0;
        at_once.peak_force = 0.5 * double(spec.peak_force);
        Safety other(spec, at_once);
        for (int i = 1; i < 100; ++i)
            last = other.allow({vec3(0), i < 3 ? vec3(0) : vec3(0, 1, 0)}, {.time = i * 1e-3}, dvec3(0),
                               dvec3(0), i * 1e-3);
        EXPECT_NEAR(last.torque.y, peak, 1e-6f);
    }
    EXPECT_THROW(Safety({.peak_torque = 1}, {}), Error);
    EXPECT_THROW(Safety({.peak_torque = NAN, .lasting_torque = 1}, {}), Error);
    EXPECT_THROW(Safety({.workspace = 0}, {}), Error);
}

TEST(Safety, NoForceBridgesAPlacing) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(vec3(0, 2, 0));
    ++c.state.placed;
    EXPECT_EQ(c.tick(vec3(0, 2, 0)), vec3(0));
}

TEST(Safety, NumbersThatAreNoneTogetherAreNothing) {
    Clocked c;
    c.arm();
    for (float large : {3e38f, -3e38f, 1e30f}) {
        for (int i = 0; i < 3; ++i) c.tick(vec3(large, large, -large), true, dvec3(1e308));
        c.state.pose.place = dvec3(1e308, -1e308, 1e308);
        for (int i = 0; i < 3; ++i) c.tick(vec3(0, 1, 0), true, dvec3(1e300));
        c.state.pose.place = dvec3(0);
    }
}

}  // namespace
}  // namespace palpate
