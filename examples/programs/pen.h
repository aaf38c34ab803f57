#pragma once
// A driver outside of Palpate: a pen on an arm that reports its position and orientation, and can exert a
// force and a torque on the hand that holds it. This one has neither arm nor hand, so it moves down by itself
// and draws circles; comments mark where yours talks to its hardware.
#include <palpate/touch/device.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

class Pen final : public palpate::Device {
 public:
    palpate::DeviceSpec spec() const override {
        return {.name = "pen",
                .workspace = 0.16f,
                .peak_force = 3,
                .lasting_force = 1,
                .peak_torque = 0.1f,
                .lasting_torque = 0.03f,
                .stiffness = 800,
                .turns = true};
    }

    // Here the hardware is opened, and its own watchdog switched on.
    void open() override { start_.reset(); }

    // Here its encoders are read, or the newest values from its own thread (SequenceLock).
    bool read(double now, palpate::DeviceState& state) noexcept override {
        if (!start_) start_ = now;
        const double seconds = now - *start_, angle = 2 * seconds;
        const glm::dvec3 outward(std::cos(angle), 0, std::sin(angle)), around(-outward.z, 0, outward.x);
        const double height = std::max(0.03 - 0.02 * seconds, -0.001);
        state.pose.place = 0.02 * outward + glm::dvec3(0, height, 0);
        state.pose.turn = glm::angleAxis(0.3, around);  // it leans outward
        state.time = now;
        return true;
    }

    // Here the motors are commanded. A write that a stop interrupts must not take effect after it.
    bool write(const palpate::Wrench& wrench) noexcept override {
        stops_before_write_ = stops_;
        written_ = wrench;
        return true;
    }

    // Here their current is cut: one write to a register.
    void stop() noexcept override { ++stops_; }

    // What acts on the hand now; to be called on the thread that writes.
    palpate::Wrench wrench() const { return stops_before_write_ == stops_ ? written_ : palpate::Wrench{}; }

 private:
    std::optional<double> start_;  // s, of the first read
    palpate::Wrench written_;
    unsigned stops_before_write_ = 0;
    std::atomic<unsigned> stops_ = 0;
};
