// Each device against what it must do in closed form. conformance_test.cpp has what is common to all, and
// decorators_test.cpp what goes around them.
#include "palpate/base/error.h"
#include "palpate/touch/devices/mouse.h"
#include "palpate/touch/devices/playback.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/drivers.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <complex>
#include <random>
#include <thread>

namespace palpate {
namespace {

using Complex = std::complex<long double>;

// A second, independent solution of x'' + c x' + k x = 0: by the roots of its polynomial, in higher
// precision. Not for critical damping.
double by_roots(double x, double v, double k, double c, double t) {
    const Complex root = std::sqrt(Complex(c * c / 4.0L - k)), a = -c / 2.0L + root, b = -c / 2.0L - root;
    const Complex of_b = (Complex(v) - a * (long double)x) / (b - a), of_a = (long double)x - of_b;
    return double((of_a * std::exp(a * (long double)t) + of_b * std::exp(b * (long double)t)).real());
}

TEST(DampedSpring, AgreesWithItsRoots) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(0, 1), sign(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const double k = std::pow(10, 6 * part(random)), c = std::pow(10, 4 * part(random) - 1);
        const double t = std::pow(10, 4 * part(random) - 4), x = sign(random), v = 10 * sign(random);
        const Swing swing = after({dvec3(x, 0, -2 * x), dvec3(v, 0, -2 * v)}, {k, c}, t);
        const double truth = by_roots(x, v, k, c, t), size = std::abs(x) + std::abs(v) / std::sqrt(k);
        EXPECT_LE(std::abs(swing.offset.x - truth), 1e-11 * size) << k << " " << c << " " << t;
        EXPECT_LE(std::abs(swing.offset.z + 2 * truth), 1e-11 * 2 * size);
        EXPECT_EQ(swing.offset.y, 0);
    }
}

TEST(DampedSpring, CriticalDampingHasItsOwnSolution) {
    for (double nearly : {1.0, 1 - 1e-15, 1 + 1e-15, 1 + 1e-12})
        for (double t : {0.0, 1e-3, 0.02, 0.5}) {
            const double rate = 50, x = 0.3, v = -4;
            const Swing swing = after({dvec3(x), dvec3(v)}, {rate * rate, 2 * rate * nearly}, t);
            const double decay = std::exp(-rate * t), slope = v + rate * x;
            EXPECT_LE(std::abs(swing.offset.x - decay * (x + slope * t)), 1e-11);
            EXPECT_LE(std::abs(swing.velocity.x - decay * (v - rate * slope * t)), 1e-9);
        }
}

TEST(DampedSpring, StepsAddUpHoweverStiffItIs) {
    for (const DampedSpring spring :
         {DampedSpring{1e12, 1}, DampedSpring{1e12, 1e9}, DampedSpring{1, 1e6}, DampedSpring{4, 0}}) {
        const Swing start{dvec3(1, 2, 3), dvec3(-3, 1, 0)};
        Swing many = start;
        for (int i = 0; i < 1000; ++i) many = after(many, spring, 1e-3);
        const Swing one = after(start, spring, 1);
        EXPECT_LE(length(many.offset - one.offset), 1e-9);
        EXPECT_LE(length(after(start, spring, 1e9).offset), 4.0);  // and nothing overflows
    }
}

constexpr VirtualHandSettings person{.mass = 0.2, .damping = 2, .stiffness = 300};
constexpr double omega2 = 300 / 0.2, braking = 2 / 0.2;

// A hand after `seconds` of a loop that writes force(its time) each tick; `seconds` is a whole number of its
// ticks.
template <class Force>
void run(VirtualHand& hand, double rate, double seconds, Force force) {
    hand.open();
    DeviceState ignored;
    const int ticks = int(std::lround(seconds * rate));
    for (int i = 0; i < ticks; ++i) {
        EXPECT_TRUE(hand.read(i / rate, ignored));
        EXPECT_TRUE(hand.write({force(i / rate)}));
    }
    EXPECT_TRUE(hand.read(ticks / rate, ignored));
}

class VirtualHandAt : public testing::TestWithParam<double> {};

TEST_P(VirtualHandAt, SwingsAsItsEquationDoes) {
    VirtualHand hand({{0, vec3(0.1f, 0, 0)}}, person);
    const vec3 pull(-2, 1, 0.5f);
    for (double t : {0.0, 0.004, 0.1, 0.5, 1.6}) {
        // Pulled aside for 0.2 s, then let go: free damped oscillation.
        run(hand, GetParam(), 0.2 + t, [&](double now) { return now < 0.2 - 1e-9 ? pull : vec3(0); });
        const double part = 1 / 300.0, aside = part - by_roots(part, 0, omega2, braking, 0.2);
        const double later = 1e-7, speed = (-by_roots(part, 0, omega2, braking, 0.2 + later) +
                                            by_roots(part, 0, omega2, braking, 0.2 - later)) /
                                           (2 * later);
        const double swing = by_roots(aside, speed, omega2, braking, t);
        const dvec3 truth = dvec3(0.1f, 0, 0) + dvec3(pull) * swing;
        EXPECT_LE(length(hand.position() - truth), 1e-9) << t;
    }
}

TEST_P(VirtualHandAt, GivesWayToAForceByItsStiffness) {
    VirtualHand hand({{0, vec3(0, 0.5f, 0)}}, person);
    run(hand, GetParam(), 10, [](double) { return vec3(3, -1.5f, 0); });
    EXPECT_LE(length(hand.position() - dvec3(0.01, 0.5 - 0.005, 0)), 1e-9);
    EXPECT_LE(length(hand.velocity()), 1e-9);
}

TEST_P(VirtualHandAt, FollowsItsPlanAroundItsBends) {
    // At each bend the plan's speed changes, which starts a swing of its own. Bends lie between ticks.
    const Path plan = {{0.1003, vec3(0)}, {0.3001, vec3(0.1f, 0, 0)}, {0.5507, vec3(0.1f, 0.2f, 0)}};
    VirtualHand hand(plan, person);
    for (double t : {0.1, 0.24, 0.4, 1.2}) {
        run(hand, GetParam(), t, [](double) { return vec3(0); });
        dvec3 truth(position(plan, 0));
        dvec3 speed(0);
        for (std::size_t i = 0; i < plan.size(); ++i) {
            const double since = t - plan[i].time;
            if (since <= 0) break;
            const dvec3 before = speed;
            speed = i + 1 < plan.size() ? (dvec3(plan[i + 1].position) - dvec3(plan[i].position)) /
                                              (plan[i + 1].time - plan[i].time)
                                        : dvec3(0);
            truth += (speed - before) * (since + by_roots(0, -1, omega2, braking, since));
        }
        EXPECT_LE(length(hand.position() - truth), 1e-9) << t;
    }
}

TEST_P(VirtualHandAt, ADelayedForceComesThatMuchLater) {
    VirtualHandSettings late = person;
    late.delay = 0.0137;  // no whole number of ticks
    VirtualHand hand({{0, vec3(0)}}, late);
    for (double t : {0.004, 0.012, 0.016, 0.2}) {
        run(hand, GetParam(), t, [](double) { return vec3(0, 0, 3); });
        const double since = std::max(0.0, t - late.delay);
        EXPECT_LE(std::abs(hand.position().z - 0.01 * (1 - by_roots(1, 0, omega2, braking, since))), 1e-9)
            << t;
    }
}

// The stiffest spring to the origin under which a person, who reads and is pushed once a tick, does not swing
// ever wider: with x(n+1) = A x(n) + b force and force = -K x, the product of the eigenvalues reaches 1. A
// and b by their series.
double stiffest(const VirtualHandSettings& s, double tick) {
    struct Pair {
        long double place, speed;
    };
    auto rate = [&](Pair p, long double force) {
        return Pair{p.speed,
                    (force - (long double)s.stiffness * p.place - (long double)s.damping * p.speed) / s.mass};
    };
    auto after_a_tick = [&](Pair p, long double force) {
        Pair term = rate(p, force), sum = p;
        long double part = tick;
        for (int n = 2; n < 40; ++n) {
            sum = {sum.place + part * term.place, sum.speed + part * term.speed};
            term = rate(term, 0);
            part *= (long double)tick / n;
        }
        return sum;
    };
    const Pair a = after_a_tick({1, 0}, 0), c = after_a_tick({0, 1}, 0), b = after_a_tick({0, 0}, 1);
    const long double product = a.place * c.speed - a.speed * c.place;
    return double((1 - product) / (b.speed * c.place - b.place * c.speed));
}

TEST_P(VirtualHandAt, IsStableBeforeAWallUpToWhatTheoryAllows) {
    const double tick = 1 / GetParam(), limit = stiffest(person, tick);
    EXPECT_LE(std::abs(limit * tick / (2 * person.damping) - 1), 0.1);  // about 2 c / T, the well-known bound
    for (double part : {0.98, 1.02}) {
        VirtualHand hand({{0, vec3(0)}}, person);
        hand.open();
        DeviceState read;
        double early = 0, late = 0;
        const int ticks = int(60 * GetParam());
        for (int i = 0; i < ticks; ++i) {
            hand.read(i * tick, read);
            // A push to begin with, then nothing but the wall, which is felt on both sides.
            hand.write({i == 0 ? vec3(0.1f, 0, 0) : vec3(hand.position() * -part * limit)});
            const double place = std::abs(hand.position().x);
            if (i < ticks / 4) early = std::max(early, place);
            if (i >= ticks * 3 / 4) late = std::max(late, place);
        }
        // A fiftieth on either side of the limit is a factor of 1.1 each second.
        if (part < 1)
            EXPECT_LE(late, 0.1 * early);
        else
            EXPECT_GE(late, 10 * early);
    }
}

INSTANTIATE_TEST_SUITE_P(Rates, VirtualHandAt, testing::Values(250.0, 1000.0, 4000.0),
                         [](const auto& rate) { return std::to_string(int(rate.param)) + "Hz"; });

TEST(VirtualHand, ADelayOfAWholeTickIsOneTick) {
    VirtualHandSettings late = person;
    late.delay = 2e-3;
    VirtualHand hand({{0, vec3(0)}}, late), other({{0, vec3(0)}}, person);
    hand.open();
    other.open();
    DeviceState ignored;
    std::vector<vec3> written;
    for (int i = 0; i < 500; ++i) {
        hand.read(i * 1e-3, ignored);
        other.read(i * 1e-3, ignored);
        EXPECT_LE(length(hand.position() - other.position()), 1e-12);
        written.push_back(vec3(std::sin(i), 0, i % 5));
        hand.write({written.back()});
        other.write({i >= 2 ? written[i - 2] : vec3(0)});
    }
}

TEST(VirtualHand, IsReadByAnEncoder) {
    VirtualHandSettings coarse = person;
    coarse.resolution = 1e-3;
    VirtualHand hand({{0, vec3(-0.05f, 0.02f, 0)}, {1, vec3(0.06f, 0, 0)}}, coarse),
        whole({{0, vec3(-0.05f, 0.02f, 0)}, {1, vec3(0.06f, 0, 0)}}, person);
    hand.open();
    whole.open();
    DeviceState read, exact;
    for (int i = 0; i < 1500; ++i) {
        hand.read(i * 1e-3, read);
        whole.read(i * 1e-3, exact);
        EXPECT_EQ(hand.position(), whole.position());  // only what is read is rounded
        for (int axis = 0; axis < 3; ++axis) {
            const double steps = read.pose.place[axis] / 1e-3;
            EXPECT_LE(std::abs(steps - std::round(steps)), 1e-5);
            EXPECT_LE(std::abs(read.pose.place[axis] - exact.pose.place[axis]), 0.5e-3 + 1e-8);
        }
    }
}

TEST(VirtualHand, AStopAlsoTakesForcesThatAreOnTheirWay) {
    VirtualHandSettings late = person;
    late.delay = 0.05;
    VirtualHand hand({{0, vec3(0)}}, late);
    hand.open();
    DeviceState ignored;
    for (int i = 0; i < 200; ++i) {
        hand.read(i * 1e-3, ignored);
        if (i < 30) hand.write({vec3(5, 0, 0)});
        if (i == 30) hand.stop();
        EXPECT_EQ(hand.position(), dvec3(0));
    }
    hand.write({vec3(5, 0, 0)});
    hand.read(0.3, ignored);
    EXPECT_GT(hand.position().x, 1e-3);
}

TEST(VirtualHand, WhatIsNoForceDoesNotPush) {
    VirtualHand hand({{0, vec3(0)}}, person);
    hand.open();
    DeviceState read;
    hand.read(0, read);
    hand.write({vec3(NAN, 1, 0)});
    hand.read(1, read);
    EXPECT_EQ(read.pose.place, dvec3(0));
}

TEST(VirtualHand, WhatCannotBeIsSaid) {
    const auto refused = [](const std::string& word, const Path& plan, const VirtualHandSettings& settings) {
        expect_refused(word, [&] { VirtualHand(plan, settings).open(); });
    };
    const Path plan = {{0, vec3(0)}};
    EXPECT_NO_THROW(VirtualHand(plan, {}).open());
    refused("no waypoint in virtual hand; ", {}, {});
    refused("waypoint 1 is not a number", {{0, vec3(NAN)}}, {});
    refused("waypoint 2 is not later", {{1, vec3(0)}, {1, vec3(1)}}, {});
    for (const VirtualHandSettings& wrong :
         {VirtualHandSettings{.mass = 0}, VirtualHandSettings{.damping = -1},
          VirtualHandSettings{.stiffness = NAN}, VirtualHandSettings{.resolution = -1},
          VirtualHandSettings{.delay = 2}, VirtualHandSettings{.delay = NAN}})
        refused("virtual hand; ", plan, wrong);
}

TEST(Script, FollowsItsPathFromTheFirstRead) {
    const Path path = {{0, vec3(0)}, {1, vec3(0, 2, 0)}};
    Script script(path);
    script.open();
    DeviceState state;
    for (double t : {0.0, 0.25, 0.5, 1.0, 7.0}) {
        EXPECT_TRUE(script.read(64 + t, state));
        EXPECT_EQ(state.pose, pose(path, t));
        EXPECT_EQ(state.time, 64 + t);
        EXPECT_TRUE(script.write({vec3(100)}));
    }
    EXPECT_THROW(Script({}).open(), Error);
}

// ---- the mouse ----

MouseSettings before_the_origin() {
    MouseSettings settings;
    settings.camera = {.eye = vec3(0, 0, 1), .look_at = vec3(0), .up = vec3(0, 1, 0), .angle = 90};
    settings.size = ivec2(200, 100);
    return settings;
}

// Where the hand comes to rest.
vec3 settled(Mouse& mouse, double& now) {
    DeviceState state;
    mouse.read(now, state);
    now += 10;
    mouse.read(now, state);
    return vec3(state.pose.place);
}

TEST(Mouse, IsUnderThePointerAsDeepAsTheCameraLooks) {
    MouseSettings settings = before_the_origin();
    Mouse mouse(settings);
    mouse.open();
    double now = 5;
    EXPECT_LE(length(settled(mouse, now)), 1e-7f);  // the middle, before any event
    mouse.point({.position = vec2(100, 0)});
    EXPECT_LE(length(settled(mouse, now) - vec3(0, 1, 0)), 1e-6f);  // 45 degrees up
    mouse.point({.position = vec2(200, 100)});
    EXPECT_LE(length(settled(mouse, now) - vec3(2, -1, 0)), 1e-6f);
    // The wheel goes along the line of sight: what lies on it stays under the pointer.
    mouse.point({.position = vec2(200, 100), .wheel = 20});
    EXPECT_LE(length(settled(mouse, now) - vec3(2.2f, -1.1f, -0.1f)), 1e-6f);
    mouse.point({.position = vec2(200, 100), .wheel = -1e6});  // never behind the eye
    EXPECT_LE(length(settled(mouse, now) - vec3(0.02f, -0.01f, 0.99f)), 1e-6f);
    settings.camera.orthographic = true;
    mouse.look(settings.camera, settings.size);
    mouse.point({.position = vec2(200, 100), .wheel = 20});
    EXPECT_LE(length(settled(mouse, now) - vec3(2, -1, -0.1f)), 1e-6f);
    // Straight down, where up says nothing, there still is a right and an up.
    settings.camera = {.eye = vec3(0, 1, 0), .look_at = vec3(0), .angle = 90};
    mouse.look(settings.camera, settings.size);
    mouse.point({.position = vec2(100, 0)});
    const vec3 up = settled(mouse, now);
    EXPECT_LE(std::abs(up.y), 1e-6f);
    EXPECT_LE(std::abs(length(up) - 1), 1e-6f);
    // And where there is nothing to see at all, some place.
    settings.camera = {.eye = vec3(2), .look_at = vec3(2), .up = vec3(0), .angle = NAN};
    mouse.look(settings.camera, ivec2(0));
    const vec3 somewhere = settled(mouse, now);
    EXPECT_TRUE(std::isfinite(dot(somewhere, somewhere)));
}

TEST(Mouse, IsFedFromAnotherThread) {
    Mouse mouse(before_the_origin());
    mouse.open();
    std::atomic<bool> over = false;
    std::thread window([&] {
        for (int i = 0; i < 20'000; ++i) {
            // Each event is sound by itself: its button says where it is.
            const unsigned side = unsigned(i % 2);
            mouse.point({.position = vec2(side ? 150 : 50, 50), .buttons = side});
            if (i % 1000 == 0) mouse.look(before_the_origin().camera, ivec2(200, 100));
        }
        over = true;
    });
    DeviceState state;
    double now = 0;
    unsigned placed = 0;
    while (!over) {
        ASSERT_TRUE(mouse.read(now += 1, state));  // each time it has a second to come to rest
        ASSERT_GE(state.placed, placed);
        ASSERT_LE(length(state.pose.place), 1.0f);
        placed = state.placed;
    }
    window.join();
    mouse.read(now += 1, state);
    mouse.read(now += 1, state);
    EXPECT_EQ(state.buttons, 1u);
    EXPECT_LE(length(state.pose.place - dvec3(1, 0, 0)), 1e-6f);
}

TEST(Mouse, GoesToItsTargetCriticallyDamped) {
    MouseSettings settings = before_the_origin();
    const std::vector<PointerEvent> events = {
        {0.1, vec2(100, 50)}, {0.2004, vec2(100, 25)}, {0.2173, vec2(100, 0), 5}};
    for (double rate : {250.0, 1000.0, 4000.0}) {
        Mouse mouse(settings, events);
        mouse.open();
        DeviceState state;
        for (int i = 0; i <= int(0.3 * rate); ++i) {
            const double t = i / rate;
            mouse.read(64 + t, state);
            double truth = 0;  // each event is a step of half a metre, answered by 1 - exp(-u) (1 + u)
            for (double event : {0.2004, 0.2173})
                if (const double u = (t - event) / settings.smoothing; u > 0)
                    truth += 0.5 * (1 - std::exp(-u) * (1 + u));
            EXPECT_LE(length(state.pose.place - dvec3(0, truth, 0)), 1e-6) << t;
            EXPECT_EQ(state.buttons, t < 0.2173 - 1e-9 ? 0u : 5u);
            EXPECT_EQ(state.placed, t < 0.1 - 1e-9 ? 0u : 1u);  // by its first event
        }
    }
}

TEST(Mouse, AnotherViewPlacesItAnew) {
    MouseSettings settings = before_the_origin();
    Mouse mouse(settings);
    mouse.open();
    DeviceState state;
    mouse.read(0, state);
    mouse.point({.position = vec2(100, 25)});
    mouse.read(0.001, state);
    const unsigned placed = state.placed;
    mouse.read(0.002, state);
    EXPECT_EQ(state.placed, placed);
    settings.camera.look_at = vec3(0, 0, -1);
    mouse.look(settings.camera, settings.size);
    mouse.read(0.003, state);
    EXPECT_EQ(state.placed, placed + 1);
    EXPECT_LE(length(state.pose.place - dvec3(0, 1, -1)), 1e-6f);  // at once
    mouse.point({.position = vec2(100, 20)});
    mouse.read(0.004, state);
    EXPECT_EQ(state.placed, placed + 1);
}

TEST(Mouse, WhereItIsPlacedItIsAtOnceAndGoesOnFromThere) {
    Mouse mouse({.camera = {.eye = vec3(0, 0, 1), .look_at = vec3(0)}, .size = ivec2(100)});
    mouse.open();
    DeviceState state;
    mouse.point({.time = 0, .position = vec2(50)});
    mouse.read(0, state);
    const unsigned before = state.placed;
    // Both before the loop comes round: it is placed to the left, and goes to the right from there.
    mouse.place({.time = 0.001, .position = vec2(10, 50)});
    mouse.point({.time = 0.001, .position = vec2(90, 50)});
    mouse.read(0.001, state);
    EXPECT_EQ(state.placed, before + 1);
    const double left = state.pose.place.x;
    EXPECT_LT(left, -0.1f);
    mouse.read(0.002, state);
    EXPECT_GT(state.pose.place.x, left);
    EXPECT_LT(state.pose.place.x, 0);
    mouse.read(1, state);
    EXPECT_NEAR(state.pose.place.x, -left, 1e-4);
    EXPECT_EQ(state.placed, before + 1);
}

// ---- playback, and devices by name ----

TEST(Playback, GoesStraightBetweenTicksButOverNoJump) {
    Log log;
    log.ticks = {{10, {{dvec3(0)}, 10, 0, 0}, {}},
                 {11, {{dvec3(4, 0, 0), dquat(0, 0, 1, 0)}, 10.5, 1, 0}, {}},
                 {12, {{dvec3(9, 0, 0)}, 12, 0, 1}, {}}};
    Playback playback(log);
    playback.open();
    DeviceState state;
    auto at = [&](double t) {
        playback.read(100 + t, state);
        return state.pose.place.x;
    };
    EXPECT_EQ(at(0), 0);
    EXPECT_EQ(at(0.25), 1);
    EXPECT_EQ(state.time, 100.125);  // as its samples grew old
    at(0.5);
    EXPECT_LE(glm::length(state.pose.turn - dquat(std::sqrt(0.5), 0, std::sqrt(0.5), 0)), 1e-12);
    EXPECT_EQ(at(1), 4);
    EXPECT_EQ(state.buttons, 1u);
    EXPECT_EQ(at(1.75), 4);
    EXPECT_EQ(at(2), 9);
    EXPECT_EQ(at(50), 9);
    EXPECT_EQ(state.time, 150);
    EXPECT_THROW(Playback(Log{}).open(), Error);
}

TEST(Drivers, AreKnownByName) {
    const Scratch folder;
    Log log;
    log.ticks.push_back({});
    write_log(folder / "log.csv", log);
    const DeviceSettings settings{.path = {{0, vec3(0)}}, .log = folder / "log.csv"};
    for (const Driver& named : drivers()) {
        auto device = driver(named.name).make(settings);
        ASSERT_TRUE(device) << named.name;
        device->open();
        DeviceState state;
        EXPECT_TRUE(device->read(0, state)) << named.name;
    }
    EXPECT_EQ(refusal([] { driver("mose"); }),
              "no device \"mose\" in the list of devices; did you mean \"mouse\"? There are hand, "
              "script, mouse, playback");
    EXPECT_THROW(driver("playback").make({.log = "/nowhere"}), Error);
    EXPECT_THROW(driver("script").make({})->open(), Error);
}

}  // namespace
}  // namespace palpate
