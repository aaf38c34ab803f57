// Whatever ends the process, no motor goes on holding a force: seen from outside, in memory that the motor of
// a copy of this process shares with it.
#include "palpate/touch/emergency.h"

#include "palpate/base/clock.h"
#include "palpate/touch/loop.h"
#include "tests/copy_of_process.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>

namespace palpate {
namespace {

// It holds what it was told last, whatever becomes of who told it, as hardware does.
struct Motor {
    std::atomic<float> holds = 0;  // N
    std::atomic<int> stops = 0, pushed = 0;
};

// A hand that is above a surface and then in it.
class Pressing final : public Device {
 public:
    explicit Pressing(Motor& motor) : motor_(motor) {}

    DeviceSpec spec() const override { return {.name = "motor"}; }
    void open() override {}
    bool read(double now, DeviceState& state) noexcept override {
        // Where the machine let the loop stall on the way in, nothing pushes: once more, from above.
        const bool again = motor_.pushed == 0 && now - start_ > 0.4;
        if (start_ < 0 || again) start_ = now;
        const double depth = std::clamp((now - start_ - 0.05) / 0.1, -0.2, 1.0) * 0.005;
        state = {.pose = {.place = dvec3(0, 0.003 - depth, 0)}, .time = now};
        return true;
    }
    bool write(const Wrench& wrench) noexcept override {
        motor_.holds = glm::length(wrench.force);
        if (motor_.holds > 0.5f) motor_.pushed = 1;
        return true;
    }
    void stop() noexcept override {
        motor_.holds = 0;
        ++motor_.stops;
    }

 private:
    Motor& motor_;
    double start_ = -1;  // s
};

TouchSettings at_once() {
    return {.radius = 0.003, .feels = {{.stiffness = 300}}, .safety = {.calm = 0, .ramp = 0}};
}

class Emergency : public testing::Test {
 protected:
    void SetUp() override {
#ifdef __SANITIZE_THREAD__
        GTEST_SKIP() << "not available: under the thread sanitizer a copy of a process can start no thread";
#endif
    }
    // A copy that pushes, and then does that.
    pid_t start(bool lets_go, const std::function<void()>& then) {
        motor_->pushed = 0;
        return start_copy([&] {
            setpgid(0, 0);  // so that a terminal's signals may pause it
            if (lets_go) let_go_at_halt();
            const Mesh mesh = block(vec3(-0.1f, -0.05f, -0.1f), vec3(0.1f, 0, 0.1f), 8);
            const Touchable one[] = {{mesh.positions, mesh.triangles}};
            Touch touch(std::make_unique<Pressing>(*motor_), at_once());
            touch.feel(Patch(one));
            const TouchLoop loop({&touch});
            while (motor_->pushed == 0) usleep(1000);
            then();
            while (true) pause();
        });
    }
    void wait_until_it_pushes() {
        wait_until([&] { return motor_->pushed == 1; });
        ASSERT_EQ(motor_->pushed, 1);
    }
    static void end(pid_t copy) {
        kill(copy, SIGKILL);
        wait_for(copy);
    }

    WithCopies<Motor> motor_;
};

TEST_F(Emergency, NoMotorHoldsAForceAfterTheProcess) {
    const std::pair<const char*, std::function<void()>> ends[] = {
        {"SIGINT", [] { kill(getpid(), SIGINT); }},
        {"SIGTERM", [] { kill(getpid(), SIGTERM); }},
        {"SIGSEGV", [] { raise(SIGSEGV); }},  // a wild pointer itself a sanitizer ends in its own way
        {"abort", [] { std::abort(); }},
        {"nobody catches it", [] { std::thread([] { throw std::runtime_error("so"); }).join(); }},
        {"quick_exit", [] { std::quick_exit(0); }},
    };
    for (const auto& [name, end] : ends) {
        const pid_t copy = start(true, end);
        wait_until_it_pushes();
        wait_for(copy);
        EXPECT_EQ(motor_->holds, 0) << name;
    }
}

// Else the test above would show nothing.
TEST_F(Emergency, UnaskedTheLibraryTakesNoSignals) {
    const pid_t copy = start(false, [] { kill(getpid(), SIGKILL); });
    wait_until_it_pushes();
    wait_for(copy);
    EXPECT_GT(motor_->holds, 0);
}

TEST_F(Emergency, APausedProcessHoldsNobodyAndBeginsAnew) {
    const pid_t copy = start(true, [] {});
    wait_until_it_pushes();
    kill(copy, SIGTSTP);
    const int status = wait_for(copy, WUNTRACED);
    ASSERT_TRUE(WIFSTOPPED(status));
    EXPECT_EQ(motor_->holds, 0);
    // The hand is still in the surface: no force until it was out.
    kill(copy, SIGCONT);
    for (int i = 0; i < 50; ++i) {
        usleep(1000);
        EXPECT_EQ(motor_->holds, 0);
    }
    end(copy);
}

// SIGSTOP cannot be caught. But when it goes on it begins anew.
TEST_F(Emergency, AfterAStopThatNobodyHeardItBeginsAnew) {
    const pid_t copy = start(true, [] {});
    wait_until_it_pushes();
    kill(copy, SIGSTOP);
    wait_for(copy, WUNTRACED);
    usleep(30'000);
    kill(copy, SIGCONT);
    wait_until([&] { return motor_->holds == 0; });
    EXPECT_EQ(motor_->holds, 0);
    end(copy);
}

TEST_F(Emergency, LetsGoOfAllHandsThatAreThereAndOfNoOthers) {
    Motor motors[2];
    const Mesh mesh = block(vec3(-0.1f, -0.05f, -0.1f), vec3(0.1f, 0, 0.1f), 8);
    const Touchable surface[] = {{mesh.positions, mesh.triangles}};
    Touch one(std::make_unique<Pressing>(motors[0]), at_once());
    {
        Touch two(std::make_unique<Pressing>(motors[1]), at_once());
        for (Touch* touch : {&one, &two}) touch->feel(Patch(surface));
        for (int i = 1; i < 200; ++i) {
            one.tick(i * 1e-3);
            two.tick(i * 1e-3);
        }
        EXPECT_GT(motors[0].holds, 1);
        EXPECT_GT(motors[1].holds, 1);
        let_go_of_all();
        EXPECT_EQ(motors[0].holds, 0);
        EXPECT_EQ(motors[1].holds, 0);
        for (int i = 200; i < 210; ++i) {
            one.tick(i * 1e-3);
            EXPECT_EQ(motors[0].holds, 0);
        }
    }
    const int stops = motors[1].stops;
    let_go_of_all();
    EXPECT_EQ(motors[1].stops, stops);
}

// Hands come and go while another thread lets go of all; for the thread sanitizer too.
TEST_F(Emergency, HandsMayComeAndGoMeanwhile) {
    std::atomic<bool> ends = false;
    std::thread other([&] {
        while (!ends) let_go_of_all();
    });
    Motor motor;
    for (int i = 0; i < 200; ++i) {
        Touch touch(std::make_unique<Pressing>(motor), at_once());
        touch.tick(1);
    }
    ends = true;
    other.join();
}

}  // namespace
}  // namespace palpate
