#pragma once
// What every device must do, whoever wrote its driver. Include this in one source file of a test program,
// link it with allocations.cpp and say which devices there are:
//
//     const palpate::Specimen mine{"mine", [] { return palpate::Subject{std::make_unique<MyDevice>()}; }};
//     INSTANTIATE_TEST_SUITE_P(Mine, Conformance, testing::Values(mine), palpate::specimen_name);
#include "palpate/base/error.h"
#include "palpate/touch/device.h"
#include "tests/touch/allocations.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>

namespace palpate {

/// A device, and how a test looks behind it.
struct Subject {
    std::unique_ptr<Device> device;
    std::function<Wrench()> wrench =
        {};  // that its motors push with now; empty: it has none that could be asked
};

/// A device not yet made: each test makes its own.
struct Specimen {
    std::string name;  // letters and digits
    std::function<Subject()> make;
    bool stays = true;  // whether it is there all the time; else it is gone at times, and says so
};

inline void PrintTo(const Specimen& specimen, std::ostream* out) { *out << specimen.name; }
inline std::string specimen_name(const testing::TestParamInfo<Specimen>& info) { return info.param.name; }

class Conformance : public testing::TestWithParam<Specimen> {
 protected:
    static constexpr double begin = 1234.5;  // s: a loop's clock need not begin at 0
    static constexpr double tick = 1e-3;     // s
    static constexpr Wrench push = {vec3(0.3f, -0.2f, 0.1f), vec3(0.01f, 0, -0.02f)};

    Subject subject_ = GetParam().make();
    Device& device_ = *subject_.device;
};

inline bool same(const DeviceState& a, const DeviceState& b) {
    return std::memcmp(&a.pose, &b.pose, sizeof a.pose) == 0 && a.time == b.time && a.buttons == b.buttons &&
           a.placed == b.placed;
}

inline void expect_scale(const DeviceState& state) {
    EXPECT_TRUE(std::isfinite(state.forces) && state.forces > 0);
    EXPECT_TRUE(std::isfinite(state.motion) && state.motion > 0);
}

// Finite, and turned by something that turns.
inline void expect_pose(const Pose& pose) {
    EXPECT_TRUE(std::isfinite(glm::dot(pose.place, pose.place)));
    EXPECT_NEAR(glm::length(pose.turn), 1, 1e-6);
}

TEST_P(Conformance, ItsSpecIsSaneBeforeItIsOpenAndAfter) {
    for (int times = 0; times < 2; ++times) {
        const DeviceSpec spec = device_.spec();
        EXPECT_FALSE(spec.name.empty());
        EXPECT_EQ(spec.name.find_first_of("\r\n"), spec.name.npos);
        EXPECT_GT(spec.lasting_force, 0);
        EXPECT_GE(spec.peak_force, spec.lasting_force);
        EXPECT_TRUE(std::isfinite(spec.peak_force));
        EXPECT_GE(spec.lasting_torque, 0);
        EXPECT_GE(spec.peak_torque, spec.lasting_torque);
        EXPECT_EQ(spec.lasting_torque > 0, spec.peak_torque > 0);
        EXPECT_TRUE(std::isfinite(spec.peak_torque));
        EXPECT_GT(spec.workspace, 0);
        EXPECT_TRUE(std::isfinite(spec.workspace));
        EXPECT_GT(spec.stiffness, 0);
        EXPECT_TRUE(std::isfinite(spec.stiffness));
        device_.open();
    }
}

TEST_P(Conformance, APoseIsFiniteAndOfItsTime) {
    device_.open();
    DeviceState state, last{.time = -std::numeric_limits<double>::infinity()};
    bool was_gone = false;
    for (int i = 0; i < 3000; ++i) {
        const double now = begin + i * tick;
        const DeviceState before = state;
        if (!device_.read(now, state)) {
            was_gone = true;
            EXPECT_TRUE(same(state, before)) << "a device that is gone leaves the state as it was";
            device_.write(push);
            continue;
        }
        expect_pose(state.pose);
        EXPECT_LE(state.time, now);
        EXPECT_GE(state.time, last.time);
        EXPECT_GE(state.placed, last.placed);
        expect_scale(state);
        last = state;
        device_.write({push.force * float(i % 7), push.torque * float(i % 5)});
    }
    EXPECT_EQ(was_gone, !GetParam().stays);
    device_.stop();
}

TEST_P(Conformance, TicksNeedNotBeEven) {
    device_.open();
    DeviceState state;
    double now = begin, last = 0;
    for (double later : {0.0, 0.0, 1e-3, 1e-9, 0.0, 3e-3, 2.5, 1e-4, 60.0, 1e-3}) {
        now += later;
        if (!device_.read(now, state)) continue;
        expect_pose(state.pose);
        EXPECT_LE(state.time, now);
        EXPECT_GE(state.time, last);
        last = state.time;
        device_.write(push);
    }
}

TEST_P(Conformance, ReadingAndWritingNeverAllocate) {
    device_.open();
    DeviceState state;
    const std::size_t before = allocations();
    for (int i = 0; i < 3000; ++i) {
        device_.read(begin + i * tick, state);
        device_.write(push);
        if (i % 100 == 0) device_.stop();
    }
    EXPECT_EQ(allocations() - before, 0u);
}

TEST_P(Conformance, AfterAStopNoForceUntilTheNextWrite) {
    device_.open();
    DeviceState state;
    auto wrench = [&] { return subject_.wrench ? subject_.wrench() : Wrench{}; };
    for (int i = 0; i < 100; ++i) {
        device_.read(begin + i * tick, state);
        device_.write(push);
    }
    if (subject_.wrench && GetParam().stays) {
        EXPECT_NE(wrench(), Wrench{});
    }
    device_.stop();
    EXPECT_EQ(wrench(), Wrench{});
    for (int i = 100; i < 200; ++i) {
        device_.read(begin + i * tick, state);
        EXPECT_EQ(wrench(), Wrench{});
    }
    device_.stop();
    device_.stop();
    EXPECT_EQ(wrench(), Wrench{});
    for (int i = 200; i < 300; ++i) {
        device_.write(push);
        device_.read(begin + i * tick, state);
    }
    if (subject_.wrench && GetParam().stays) {
        EXPECT_NE(wrench(), Wrench{});
    }
    device_.stop();
}

TEST_P(Conformance, AnotherThreadMayStopIt) {
    device_.open();
    std::atomic<bool> over = false;
    std::thread watchdog([&] {
        while (!over) device_.stop();
    });
    DeviceState state;
    for (int i = 0; i < 2000; ++i) {
        device_.read(begin + i * tick, state);
        device_.write(push);
    }
    over = true;
    watchdog.join();
    device_.stop();
    if (subject_.wrench) {
        EXPECT_EQ(subject_.wrench(), Wrench{});
    }
    device_.read(begin + 2000 * tick, state);
    if (subject_.wrench) {
        EXPECT_EQ(subject_.wrench(), Wrench{});
    }
}

TEST_P(Conformance, StoppingItBeforeItIsOpenDoesNothing) {
    device_.stop();
    device_.open();
    device_.stop();
    DeviceState state;
    device_.read(begin, state);
    device_.stop();
}

TEST_P(Conformance, ItOpensTwiceOrSaysWhyNot) {
    device_.open();
    try {
        device_.open();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(device_.spec().name), std::string::npos) << error.what();
    }
    DeviceState state;
    if (device_.read(begin, state)) expect_pose(state.pose);
    device_.stop();
}

}  // namespace palpate
