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
    Hand hand = {};
    Safety safety{device, settings};
    dvec3 force = dvec3(0);
    double sharpest = 0;  // N/s

    explicit Clocked(double r = 1000, SafetySettings s = {}) : settings(s), rate(r), safety(device, s) {}

    dvec3 tick(dvec3 wanted, bool fresh = true, dvec3 velocity = dvec3(0)) {
        time += 1 / rate;
        if (fresh) hand.time = time;
        const dvec3 before = force;
        force = safety.allow(wanted, hand, velocity, dvec3(0), time);
        EXPECT_TRUE(std::isfinite(force.x + force.y + force.z));
        EXPECT_LE(glm::length(force), safety.peak_force() * (1 + 1e-9));
        sharpest = std::max(sharpest, glm::distance(force, before) * rate);
        return force;
    }
    void arm() {
        for (int i = 0; i < int(1.2 * rate); ++i) tick(dvec3(0));
        EXPECT_EQ(safety.held(), Held::no);
    }
    // How long it takes from now on until there is no force, s.
    template <class Tick>
    double until_nothing(const Tick& some) {
        const double start = time;
        for (int i = 0; i < rate; ++i) {
            some();
            if (force == dvec3(0)) return time - start;
        }
        return 1;
    }
};

TEST(Safety, BeginsWithNothingUntilLittleIsWantedAndGrowsInASecond) {
    for (double rate : {250.0, 1000.0, 4000.0}) {
        Clocked c(rate);
        for (int i = 0; i < rate; ++i) EXPECT_EQ(c.tick(dvec3(0, 0.5, 0)), dvec3(0));
        EXPECT_EQ(c.safety.held(), Held::waiting);
        for (int i = 0; i <= 0.02 * rate; ++i) EXPECT_LE(c.tick(dvec3(0, 0.05, 0)).y, 0.001);
        const double begin = c.time;
        while (c.time < begin + 2) {
            c.tick(dvec3(0, 0.5, 0));
            const double right = 0.5 * std::min(c.time - begin, 1.0);
            EXPECT_LE(std::abs(c.force.y - right), 0.01);
        }
        EXPECT_EQ(c.safety.held(), Held::no);
        EXPECT_EQ(c.force, dvec3(0, 0.5, 0));
    }
}

TEST(Safety, LimitsKeepTheDirectionAndTheRateOfChange) {
    std::mt19937 random(1);
    std::normal_distribution<double> any;
    Clocked c;
    c.arm();
    const dvec3 way = glm::normalize(dvec3(1, -2, 0.5));
    for (int i = 0; i < 20; ++i) c.tick(50.0 * way);
    EXPECT_LE(glm::distance(c.force, c.safety.peak_force() * way), 1e-9);
    for (int i = 0; i < 5000; ++i) c.tick(10.0 * dvec3(any(random), any(random), any(random)));
    EXPECT_LE(c.sharpest, c.safety.peak_force() / c.settings.fall * (1 + 1e-9));
}

TEST(Safety, HoldsTheMeanSquareToWhatTheDeviceCanStand) {
    Clocked c;
    c.arm();
    double square = 0;
    const int long_time = 60'000;
    for (int i = 0; i < long_time; ++i) {
        const double f = glm::length(c.tick(dvec3(0, 0, 3.3)));
        if (i >= long_time / 2) square += f * f;
    }
    const double lasting = c.device.lasting_force;
    EXPECT_LE(std::sqrt(square / (long_time / 2)), 1.01 * lasting);
    EXPECT_LE(0.9 * lasting, glm::length(c.force));
    // A small one goes on as long as one likes.
    Clocked small;
    small.arm();
    for (int i = 0; i < 30'000; ++i) small.tick(dvec3(0, 0.7, 0));
    EXPECT_EQ(small.force, dvec3(0, 0.7, 0));
}

TEST(Safety, WhatIsNotANumberIsNothing) {
    for (int what = 0; what < 4; ++what) {
        Clocked c;
        c.arm();
        for (int i = 0; i < 20; ++i) c.tick(dvec3(0, 2, 0));
        EXPECT_EQ(c.force, dvec3(0, 2, 0));
        const double zero = c.until_nothing([&] {
            if (what == 0) c.tick(dvec3(nan, 0, 0));
            if (what == 1) c.tick(dvec3(0, std::numeric_limits<double>::infinity(), 0));
            c.hand.position = what == 2 ? vec3(0, NAN, 0) : vec3(0);
            if (what == 2) c.tick(dvec3(0, 2, 0));
            if (what == 3) {
                c.time += 0.001;
                c.hand.time = nan;
                c.force = c.safety.allow(dvec3(0, 2, 0), c.hand, dvec3(0), dvec3(0), c.time);
            }
        });
        EXPECT_LE(zero, 0.025) << what;
        EXPECT_EQ(c.safety.last_reason(), Held::not_finite) << what;
        c.hand.position = vec3(0);
        c.hand.time = c.time;
        // It comes back by a new ramp, and only once little is wanted.
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(dvec3(0, 2, 0)), dvec3(0));
        c.tick(dvec3(0));  // a moment is not enough
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(dvec3(0, 2, 0)), dvec3(0));
        for (int i = 0; i < 21; ++i) c.tick(dvec3(0));
        EXPECT_EQ(c.safety.held(), Held::ramping);
        for (int i = 0; i < 500; ++i) c.tick(dvec3(0, 2, 0));
        EXPECT_LE(std::abs(c.force.y - 1), 0.02);
    }
}

TEST(Safety, OldSamplesFadeInTwentyMilliseconds) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 1, 0));
    const double start = c.hand.time;
    double last = 1;
    while (c.time < start + 0.03) {
        c.tick(dvec3(0, 1, 0), false);
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
    for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 1, 0));
    c.hand.position.x += 0.05f;
    const double zero = c.until_nothing([&] { c.tick(dvec3(0, 20, 0)); });
    EXPECT_LE(zero, 0.025);
    EXPECT_EQ(c.safety.last_reason(), Held::jumped);
    // One that is moved fast is not.
    Clocked fast;
    fast.arm();
    for (int i = 0; i < 300; ++i) {
        fast.hand.position.x += 0.002f;
        fast.tick(dvec3(0));
    }
    EXPECT_EQ(fast.safety.held(), Held::no);
}

TEST(Safety, WhatIsSetAnewRampsAnew) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 1, 0));
    ++c.hand.placed;
    c.tick(dvec3(0, 1, 0));
    EXPECT_EQ(c.safety.held(), Held::placed);
    EXPECT_LE(c.until_nothing([&] { c.tick(dvec3(0, 1, 0)); }), 0.025);
}

// A wall whose spring pushes late gives energy out; with the observer a free hand does not gain any.
TEST(Safety, APassiveWallGivesNoEnergyOut) {
    for (bool observed : {false, true}) {
        SafetySettings settings;
        settings.ramp = 0;
        settings.small_force = 1e9;
        settings.calm = 0;
        settings.fall = 1e-6;
        settings.most_damping = observed ? 50 : 0;
        Clocked c(1000, settings);
        const double mass = 0.1, stiffness = 1000, dt = 0.001;
        double x = 0.01, v = -0.05;  // m, m/s; the wall is at 0
        std::array<double, 4> late = {};
        double fastest_out = 0;
        for (int i = 0; i < 2000; ++i) {
            std::rotate(late.begin(), late.begin() + 1, late.end());
            late.back() = x < 0 ? -stiffness * x : 0;
            c.hand.position = vec3(0, float(x), 0);
            const dvec3 f = c.tick(dvec3(0, late.front(), 0), true, dvec3(0, v, 0));
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
        for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 1, 0));
        c.time += step;
        c.hand.time = c.time;
        EXPECT_EQ(c.safety.allow(dvec3(0, 1, 0), c.hand, dvec3(0), dvec3(0), c.time), dvec3(0));
        EXPECT_EQ(c.safety.last_reason(), Held::stalled);
        c.force = dvec3(0);
        for (int i = 0; i < 100; ++i) EXPECT_EQ(c.tick(dvec3(0, 1, 0)), dvec3(0));
    }
}

TEST(Safety, ASampleFromTheFutureIsNoBetterThanAnOldOne) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 1, 0));
    c.hand.time = 1e6;
    EXPECT_LE(c.until_nothing([&] { c.tick(dvec3(0, 1, 0), false); }), 0.025);
    EXPECT_EQ(c.safety.last_reason(), Held::stale);
}

// None of them may switch a limit off.
TEST(Safety, EachSettingIsChecked) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    double SafetySettings::*const all[] = {
        &SafetySettings::peak_force,   &SafetySettings::lasting_force, &SafetySettings::warm_up,
        &SafetySettings::fall,         &SafetySettings::small_force,   &SafetySettings::calm,
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
    for (auto one : {&SafetySettings::fall, &SafetySettings::fresh, &SafetySettings::fade,
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
    for (int i = 0; i < 30'000; ++i) first.tick(dvec3(0, 0, 3.3));
    const Warmth warmth = first.safety.warmth();
    EXPECT_NEAR(warmth.square, 0.9 * 0.9, 0.05);
    for (double later : {0.001, 60.0}) {
        SafetySettings settings;
        settings.calm = settings.ramp = 0;
        Safety second({}, settings, warmth);
        dvec3 force(0);
        for (int i = 0; i < 50; ++i) {
            const double now = warmth.time + later + i * 1e-3;
            const Hand hand{.time = now};
            force = second.allow(dvec3(0, 0, i < 3 ? 0 : 3.3), hand, dvec3(0), dvec3(0), now);
        }
        if (later < 1)
            EXPECT_LE(glm::length(force), 1.2);
        else
            EXPECT_NEAR(glm::length(force), 3.3, 1e-6);
    }
}

TEST(Safety, NoForceBridgesAPlacing) {
    Clocked c;
    c.arm();
    for (int i = 0; i < 30; ++i) c.tick(dvec3(0, 2, 0));
    ++c.hand.placed;
    EXPECT_EQ(c.tick(dvec3(0, 2, 0)), dvec3(0));
}

TEST(Safety, NumbersThatAreNoneTogetherAreNothing) {
    Clocked c;
    c.arm();
    for (double large : {1e308, -1e308, 1e300}) {
        for (int i = 0; i < 3; ++i) c.tick(dvec3(large, large, -large), true, dvec3(large));
        c.hand.position = vec3(3e38f, -3e38f, 3e38f);
        for (int i = 0; i < 3; ++i) c.tick(dvec3(0, 1, 0), true, dvec3(1e300));
        c.hand.position = vec3(0);
    }
}

}  // namespace
}  // namespace palpate
