// What goes around a device, each by itself and one around the other.
#include "palpate/base/error.h"
#include "palpate/touch/devices/clutch.h"
#include "palpate/touch/devices/faulty.h"
#include "palpate/touch/devices/recorder.h"
#include "palpate/touch/devices/scaled.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/make_device.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

std::unique_ptr<Device> straight() {  // 0.1 m/s along x
    return std::make_unique<Script>(Path{{0, vec3(0)}, {100, vec3(10, 0, 0)}});
}

// Remembers the last force, and says what it was told to.
class Puppet : public Device {
 public:
    DeviceSpec spec() const override {
        return {.name = "puppet", .peak_force = 3, .lasting_force = 1, .stiffness = 800};
    }
    void open() override {}
    bool read(double now, Hand& hand) noexcept override {
        hand = says;
        hand.time = now;
        return true;
    }
    bool write(vec3 f) noexcept override {
        force = f;
        return true;
    }
    void stop() noexcept override { force = vec3(0); }

    Hand says;
    vec3 force = vec3(0);
};

TEST(Scaled, KeepsAWallsStiffnessUnlessToldOtherwise) {
    auto inner = std::make_unique<Puppet>();
    Puppet& puppet = *inner;
    Scaled scaled(std::move(inner), {.about = vec3(1, 0, 0), .motion = 0.1f});
    scaled.open();
    Hand hand;
    puppet.says.position = vec3(1.5f, 2, 0);
    scaled.read(0, hand);
    EXPECT_LE(length(hand.position - vec3(1.05f, 0.2f, 0)), 1e-6f);
    scaled.write(vec3(0, 0.2f, 0));
    EXPECT_LE(length(puppet.force - vec3(0, 2, 0)), 1e-6f);
    EXPECT_FLOAT_EQ(scaled.spec().stiffness, 800);
    EXPECT_FLOAT_EQ(scaled.spec().peak_force, 0.3f);
    EXPECT_FLOAT_EQ(scaled.spec().lasting_force, 0.1f);

    EXPECT_EQ(hand.placed, 0u);
    scaled.set({.about = vec3(0), .motion = 2, .forces = 3});
    scaled.read(1, hand);
    EXPECT_EQ(hand.placed, 1u);
    EXPECT_EQ(hand.position, vec3(3, 4, 0));
    scaled.write(vec3(0, 0, 0.5f));
    EXPECT_EQ(puppet.force, vec3(0, 0, 1.5f));
    scaled.write(vec3(30, 0, 40));  // more than its motors have
    EXPECT_LE(length(puppet.force - vec3(1.8f, 0, 2.4f)), 1e-6f);
    scaled.read(2, hand);
    EXPECT_EQ(hand.placed, 1u);
    EXPECT_THROW(Scaled(straight(), {.motion = 0}).open(), Error);
    EXPECT_THROW(Scaled(straight(), {.motion = 1, .forces = -1}).open(), Error);
    for (const Scale& none : {Scale{.motion = 0}, Scale{.motion = 1e-30f}, Scale{.motion = NAN},
                              Scale{.motion = 1, .forces = NAN}, Scale{.about = vec3(NAN)}})
        EXPECT_THROW(scaled.set(none), Error);
    scaled.read(3, hand);
    EXPECT_EQ(hand.placed, 1u);
    EXPECT_FLOAT_EQ(hand.forces, 3 / 10.0f);  // against what spec() said
    EXPECT_FLOAT_EQ(hand.motion, 2 / 0.1f);
}

TEST(Decorators, WantADeviceAndSettingsThatAreSome) {
    EXPECT_THROW(Clutch(nullptr), Error);
    EXPECT_THROW(Recorder(straight(), NAN), Error);
    EXPECT_THROW(Recorder(straight(), 1, -1), Error);
    EXPECT_THROW(Recorder(straight(), 1e30, 1000), Error);
    EXPECT_THROW(Faulty(straight(), {}, {}), Error);
    EXPECT_THROW(Faulty(straight(), {{.from = 0, .to = NAN}}, [](double) {}), Error);
}

TEST(Clutch, HoldsThePositionAndGoesOnFromThere) {
    auto inner = std::make_unique<Puppet>();
    Puppet& puppet = *inner;
    Clutch clutch(std::move(inner), 2);
    clutch.open();
    Hand hand;
    auto at = [&](float x) {
        puppet.says.position = vec3(x, 0, 0);
        clutch.read(x, hand);
        clutch.write(vec3(1, 0, 0));
        return hand.position.x;
    };
    EXPECT_EQ(at(1), 1);
    clutch.hold(true);
    EXPECT_EQ(at(2), 1);
    EXPECT_EQ(puppet.force, vec3(0));
    EXPECT_EQ(hand.time, 2);  // it is held, not old
    EXPECT_EQ(at(5), 1);
    EXPECT_EQ(hand.placed, 0u);
    clutch.hold(false);
    EXPECT_EQ(at(5.5f), 1);
    EXPECT_EQ(hand.placed, 1u);
    EXPECT_EQ(puppet.force, vec3(1, 0, 0));
    EXPECT_EQ(at(6), 1.5f);
    puppet.says.buttons = 3;
    EXPECT_EQ(at(9), 1.5f);
    EXPECT_EQ(hand.buttons, 3u);
    puppet.says.buttons = 1;
    at(NAN);
    EXPECT_TRUE(std::isnan(hand.position.x));
    EXPECT_EQ(at(10), 1.5f);
    EXPECT_EQ(at(11), 2.5f);
    EXPECT_EQ(hand.placed, 2u);
}

TEST(Recorder, WhatItRecordsPlaysBackToTheBit) {
    std::vector<Fault> faults = {{.kind = FaultKind::jump, .from = 0.3, .to = 0.4},
                                 {.kind = FaultKind::freeze, .from = 0.6, .to = 0.7},
                                 {.kind = FaultKind::vanish, .from = 0.8, .to = 0.9}};
    auto hand = std::make_unique<VirtualHand>(Path{{0, vec3(0.1f)}, {0.5, vec3(0.3f, 0, 0)}});
    Recorder recorder(std::make_unique<Faulty>(std::move(hand), faults, [](double) {}), 2);
    recorder.open();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uneven(0, 2e-3);
    struct Seen {
        double now;
        bool there;
        Hand hand;
        vec3 force;
    };
    std::vector<Seen> seen;
    double now = 77.7;
    for (int i = 0; i < 1200; ++i, now += uneven(random)) {
        Hand read;
        const bool there = recorder.read(now, read);
        const vec3 force(float(uneven(random)), 0, 1);
        recorder.write(force);
        seen.push_back({now, there, read, force});
    }
    EXPECT_EQ(recorder.missed(), 0u);
    const Scratch folder;
    write_log(folder / "log.csv", recorder.log());
    Log log = read_log(folder / "log.csv");
    EXPECT_EQ(log.device, "virtual hand");

    std::size_t line = 0;
    auto playback = make_device("playback", {.log = folder / "log.csv"});
    playback->open();
    for (const Seen& s : seen) {
        Hand played;
        ASSERT_TRUE(playback->read(s.now, played));
        if (!s.there) continue;
        EXPECT_EQ(played.position, s.hand.position);
        EXPECT_EQ(played.time, s.hand.time);
        EXPECT_EQ(log.ticks.at(line++).force, s.force);
    }
    EXPECT_EQ(line, log.ticks.size());
    EXPECT_LT(line, seen.size());
}

TEST(Recorder, SaysWhenItIsFull) {
    Recorder recorder(straight(), 0.1);
    recorder.open();
    Hand hand;
    for (int i = 0; i < 150; ++i) {
        EXPECT_TRUE(recorder.read(i * 1e-3, hand));
        EXPECT_TRUE(recorder.write(vec3(float(i), 0, 0)));
    }
    EXPECT_EQ(recorder.missed(), 50u);
    ASSERT_EQ(recorder.log().ticks.size(), 100u);
    EXPECT_EQ(recorder.log().ticks.back().force.x, 99);
}

TEST(Faulty, FailsOnSchedule) {
    double now = 1000;
    std::vector<Fault> faults;
    double from = 0.1;
    for (FaultKind kind : {FaultKind::no_number, FaultKind::jump, FaultKind::vanish, FaultKind::stall,
                           FaultKind::freeze, FaultKind::refuse}) {
        faults.push_back({.kind = kind, .from = from, .to = from + 0.05});
        from += 0.1;
    }
    auto inner = std::make_unique<VirtualHand>(Path{{0, vec3(0)}, {100, vec3(10, 0, 0)}});
    const VirtualHand& person_inside = *inner;
    Faulty faulty(std::move(inner), faults, [&](double seconds) { now += seconds; });
    faulty.open();
    Hand hand;
    double last = 0;
    for (int i = 0; now < 1000.75; ++i) {
        const double t = now - 1000, asked = now;
        auto during = [&](double begin) { return t >= begin && t < begin + 0.05; };
        const Hand before = hand;
        const bool there = faulty.read(now, hand);
        const bool written = faulty.write(vec3(0, 1, 0));
        EXPECT_EQ(there, !during(0.3)) << t;
        EXPECT_EQ(written, !during(0.3) && !during(0.6)) << t;
        const dvec3 true_place = person_inside.position();
        if (during(0.1)) {
            EXPECT_TRUE(std::isnan(hand.position.x));
        } else if (during(0.2)) {
            EXPECT_LE(length(dvec3(hand.position) - true_place - dvec3(0.05, 0, 0)), 1e-6);
            EXPECT_EQ(hand.placed, 0u);
        } else if (during(0.3)) {
            EXPECT_EQ(hand.position, before.position);
            EXPECT_EQ(person_inside.force(), vec3(0));
        } else if (during(0.5)) {
            EXPECT_EQ(hand.time, before.time);
            EXPECT_EQ(hand.position, before.position);
        } else {
            EXPECT_EQ(hand.position, vec3(true_place));
            EXPECT_EQ(hand.time, asked);
        }
        if (during(0.4)) EXPECT_NEAR(now, 1000.45, 1e-9);  // it did not come back before
        EXPECT_GE(hand.time, last);
        last = hand.time;
        now += 1e-3;
    }
}

TEST(Decorators, Compose) {
    auto inner = std::make_unique<Puppet>();
    Puppet& puppet = *inner;
    auto scaled = std::make_unique<Scaled>(std::move(inner), Scale{.motion = 2});
    Scaled& scale = *scaled;
    auto clutched = std::make_unique<Clutch>(std::move(scaled));
    Clutch& clutch = *clutched;
    Recorder all(std::move(clutched), 1);
    all.open();
    Hand hand;
    puppet.says.position = vec3(1, 0, 0);
    puppet.says.placed = 7;
    all.read(0, hand);
    EXPECT_EQ(hand.position.x, 2);
    clutch.hold(true);
    puppet.says.position = vec3(5, 0, 0);
    all.read(1, hand);
    clutch.hold(false);
    scale.set({.motion = 4});
    all.read(2, hand);
    EXPECT_EQ(hand.position.x, 2);
    EXPECT_EQ(hand.placed, 9u);  // its own, the clutch's and the scale's
    all.write(vec3(2, 0, 0));
    EXPECT_EQ(puppet.force.x, 0.5f);
    EXPECT_EQ(all.log().ticks.back().force.x, 2);
    EXPECT_EQ(all.spec().name, "puppet");
    all.stop();
    EXPECT_EQ(puppet.force, vec3(0));
}

}  // namespace
}  // namespace palpate
