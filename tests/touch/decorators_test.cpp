// What goes around a device, each by itself and one around the other.
#include "palpate/base/error.h"
#include "palpate/touch/devices/clutch.h"
#include "palpate/touch/devices/faulty.h"
#include "palpate/touch/devices/recorder.h"
#include "palpate/touch/devices/scaled.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/drivers.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

std::unique_ptr<Device> straight() {  // 0.1 m/s along x
    return std::make_unique<Script>(Path{{0, vec3(0)}, {100, vec3(10, 0, 0)}});
}

// Remembers what it was told last, and says what it was told to.
class Puppet : public Device {
 public:
    DeviceSpec spec() const override {
        return {.name = "puppet",
                .workspace = 0.3f,
                .peak_force = 3,
                .lasting_force = 1,
                .peak_torque = 0.5f,
                .lasting_torque = 0.1f,
                .stiffness = 800};
    }
    void open() override {}
    bool read(double now, DeviceState& state) noexcept override {
        state = says;
        state.time = now;
        return true;
    }
    bool write(const Wrench& wrench) noexcept override {
        told = wrench;
        return true;
    }
    void stop() noexcept override { told = {}; }

    DeviceState says;
    Wrench told;
};

TEST(Scaled, KeepsAWallsStiffnessUnlessToldOtherwise) {
    auto inner = std::make_unique<Puppet>();
    Puppet& puppet = *inner;
    Scaled scaled(std::move(inner), {.about = vec3(1, 0, 0), .motion = 0.1f});
    scaled.open();
    DeviceState state;
    puppet.says.pose.place = dvec3(1.5f, 2, 0);
    scaled.read(0, state);
    EXPECT_LE(length(state.pose.place - dvec3(1.05, 0.2, 0)), 1e-6);
    scaled.write({vec3(0, 0.2f, 0)});
    EXPECT_LE(length(puppet.told.force - vec3(0, 2, 0)), 1e-6f);
    EXPECT_FLOAT_EQ(scaled.spec().stiffness, 800);
    EXPECT_FLOAT_EQ(scaled.spec().peak_force, 0.3f);
    EXPECT_FLOAT_EQ(scaled.spec().lasting_force, 0.1f);
    // A metre of the device is a tenth in the scene, and so is a lever.
    EXPECT_FLOAT_EQ(scaled.spec().workspace, 0.03f);
    EXPECT_FLOAT_EQ(scaled.spec().peak_torque, 0.5f / 100);
    EXPECT_FLOAT_EQ(scaled.spec().lasting_torque, 0.1f / 100);
    scaled.write({vec3(0), vec3(0, 0.002f, 0)});
    EXPECT_LE(length(puppet.told.torque - vec3(0, 0.2f, 0)), 1e-6f);

    EXPECT_EQ(state.placed, 0u);
    scaled.set({.about = vec3(0), .motion = 2, .forces = 3});
    scaled.read(1, state);
    EXPECT_EQ(state.placed, 1u);
    EXPECT_EQ(state.pose.place, dvec3(3, 4, 0));
    scaled.write({vec3(0, 0, 0.5f)});
    EXPECT_EQ(puppet.told.force, vec3(0, 0, 1.5f));
    scaled.write({vec3(30, 0, 40), vec3(4, 3, 0)});  // more than its motors have
    EXPECT_LE(length(puppet.told.force - vec3(1.8f, 0, 2.4f)), 1e-6f);
    EXPECT_LE(length(puppet.told.torque - vec3(0.4f, 0.3f, 0)), 1e-6f);
    scaled.read(2, state);
    EXPECT_EQ(state.placed, 1u);
    EXPECT_THROW(Scaled(straight(), {.motion = 0}).open(), Error);
    EXPECT_THROW(Scaled(straight(), {.motion = 1, .forces = -1}).open(), Error);
    for (const Scale& none : {Scale{.motion = 0}, Scale{.motion = 1e-30f}, Scale{.motion = NAN},
                              Scale{.motion = 1, .forces = NAN}, Scale{.about = vec3(NAN)}})
        EXPECT_THROW(scaled.set(none), Error);
    scaled.read(3, state);
    EXPECT_EQ(state.placed, 1u);
    EXPECT_FLOAT_EQ(state.forces, 3 / 10.0f);  // against what spec() said
    EXPECT_FLOAT_EQ(state.motion, 2 / 0.1f);
}

TEST(Decorators, WantADeviceAndSettingsThatAreSome) {
    EXPECT_THROW(Clutch(nullptr), Error);
    EXPECT_THROW(Recorder(straight(), NAN), Error);
    EXPECT_THROW(Recorder(straight(), 1, -1), Error);
    EXPECT_THROW(Recorder(straight(), 1e30, 1000), Error);
    EXPECT_THROW(Faulty(straight(), {}, {}), Error);
    EXPECT_THROW(Faulty(straight(), {{.from = 0, .to = NAN}}, [](double) {}), Error);
}

TEST(Clutch, HoldsThePoseAndGoesOnFromThere) {
    auto inner = std::make_unique<Puppet>();
    Puppet& puppet = *inner;
    Clutch clutch(std::move(inner), 2);
    clutch.open();
    DeviceState state;
    auto at = [&](float x) {
        puppet.says.pose.place = dvec3(x, 0, 0);
        clutch.read(x, state);
        clutch.write({vec3(1, 0, 0)});
        return state.pose.place.x;
    };
    EXPECT_EQ(at(1), 1);
    clutch.hold(true);
    EXPECT_EQ(at(2), 1);
    EXPECT_EQ(puppet.told.force, vec3(0));
    EXPECT_EQ(state.time, 2);  // it is held, not old
    const dquat over(0, 0, 1, 0);
    puppet.says.pose.turn = over;
    EXPECT_EQ(at(5), 1);
    EXPECT_EQ(state.pose.turn, Pose{}.turn);
    EXPECT_EQ(state.placed, 0u);
    clutch.hold(false);
    EXPECT_EQ(at(5.5f), 1);
    EXPECT_EQ(state.placed, 1u);
    EXPECT_EQ(state.pose.turn, over);
    EXPECT_EQ(puppet.told.force, vec3(1, 0, 0));
    EXPECT_EQ(at(6), 1.5f);
    puppet.says.buttons = 3;
    EXPECT_EQ(at(9), 1.5f);
    EXPECT_EQ(state.buttons, 3u);
    puppet.says.buttons = 1;
    at(NAN);
    EXPECT_TRUE(std::isnan(state.pose.place.x));
    EXPECT_EQ(at(10), 1.5f);
    EXPECT_EQ(at(11), 2.5f);
    EXPECT_EQ(state.placed, 2u);
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
        DeviceState state;
        Wrench wrench;
    };
    std::vector<Seen> seen;
    double now = 77.7;
    for (int i = 0; i < 1200; ++i, now += uneven(random)) {
        DeviceState read;
        const bool there = recorder.read(now, read);
        const Wrench wrench{vec3(float(uneven(random)), 0, 1), vec3(0, float(uneven(random)), 0)};
        recorder.write(wrench);
        seen.push_back({now, there, read, wrench});
    }
    EXPECT_EQ(recorder.missed(), 0u);
    const Scratch folder;
    write_log(folder / "log.csv", recorder.log());
    Log log = read_log(folder / "log.csv");
    EXPECT_EQ(log.device, "virtual hand");

    std::size_t line = 0;
    auto playback = driver("playback").make({.log = folder / "log.csv"});
    playback->open();
    for (const Seen& s : seen) {
        DeviceState played;
        ASSERT_TRUE(playback->read(s.now, played));
        if (!s.there) continue;
        EXPECT_EQ(played.pose, s.state.pose);
        EXPECT_EQ(played.time, s.state.time);
        EXPECT_EQ(log.ticks.at(line++).wrench, s.wrench);
    }
    EXPECT_EQ(line, log.ticks.size());
    EXPECT_LT(line, seen.size());
}

TEST(Recorder, SaysWhenItIsFull) {
    Recorder recorder(straight(), 0.1);
    recorder.open();
    DeviceState state;
    for (int i = 0; i < 150; ++i) {
        EXPECT_TRUE(recorder.read(i * 1e-3, state));
        EXPECT_TRUE(recorder.write({vec3(float(i), 0, 0)}));
    }
    EXPECT_EQ(recorder.missed(), 50u);
    ASSERT_EQ(recorder.log().ticks.size(), 100u);
    EXPECT_EQ(recorder.log().ticks.back().wrench.force.x, 99);
}

TEST(Faulty, FailsOnSchedule) {
    double now = 1000;
    std::vector<Fault> faults;
    double from = 0.1;
    for (FaultKind kind : {FaultKind::not_a_number, FaultKind::jump, FaultKind::vanish, FaultKind::stall,
                           FaultKind::freeze, FaultKind::refuse}) {
        faults.push_back({.kind = kind, .from = from, .to = from + 0.05});
        from += 0.1;
    }
    auto inner = std::make_unique<VirtualHand>(Path{{0, vec3(0)}, {100, vec3(10, 0, 0)}});
    const VirtualHand& person_inside = *inner;
    Faulty faulty(std::move(inner), faults, [&](double seconds) { now += seconds; });
    faulty.open();
    DeviceState state;
    double last = 0;
    for (int i = 0; now < 1000.75; ++i) {
        const double t = now - 1000, asked = now;
        auto during = [&](double begin) { return t >= begin && t < begin + 0.05; };
        const DeviceState before = state;
        const bool there = faulty.read(now, state);
        const bool written = faulty.write({vec3(0, 1, 0)});
        EXPECT_EQ(there, !during(0.3)) << t;
        EXPECT_EQ(written, !during(0.3) && !during(0.6)) << t;
        const dvec3 true_place = person_inside.position();
        if (during(0.1)) {
            EXPECT_TRUE(std::isnan(state.pose.place.x));
        } else if (during(0.2)) {
            EXPECT_LE(length(state.pose.place - true_place - dvec3(0.05, 0, 0)), 1e-6);
            EXPECT_EQ(state.placed, 0u);
        } else if (during(0.3)) {
            EXPECT_EQ(state.pose.place, before.pose.place);
            EXPECT_EQ(person_inside.force(), vec3(0));
        } else if (during(0.5)) {
            EXPECT_EQ(state.time, before.time);
            EXPECT_EQ(state.pose.place, before.pose.place);
        } else {
            EXPECT_EQ(state.pose.place, true_place);
            EXPECT_EQ(state.time, asked);
        }
        if (during(0.4)) EXPECT_NEAR(now, 1000.45, 1e-9);  // it did not come back before
        EXPECT_GE(state.time, last);
        last = state.time;
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
    DeviceState state;
    puppet.says.pose.place = dvec3(1, 0, 0);
    puppet.says.placed = 7;
    all.read(0, state);
    EXPECT_EQ(state.pose.place.x, 2);
    clutch.hold(true);
    puppet.says.pose.place = dvec3(5, 0, 0);
    all.read(1, state);
    clutch.hold(false);
    scale.set({.motion = 4});
    all.read(2, state);
    EXPECT_EQ(state.pose.place.x, 2);
    EXPECT_EQ(state.placed, 9u);  // its own, the clutch's and the scale's
    all.write({vec3(2, 0, 0)});
    EXPECT_EQ(puppet.told.force.x, 0.5f);
    EXPECT_EQ(all.log().ticks.back().wrench.force.x, 2);
    EXPECT_EQ(all.spec().name, "puppet");
    all.stop();
    EXPECT_EQ(puppet.told.force, vec3(0));
}

}  // namespace
}  // namespace palpate
