#pragma once
#include "palpate/scene/path.h"
#include "palpate/touch/device.h"
#include "palpate/touch/devices/damped_spring.h"

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

namespace palpate {

/// The impedance of a person's arm that holds a device, and properties of the device. The defaults are those
/// that van Beek et al. (Scientific Reports 5, 18004, 2015, the trial of figure 3) measured on an arm with a
/// force-feedback device.
struct VirtualHandSettings {
    double mass = 0.554;     // kg, above 0
    double damping = 6.45;   // N·s/m, relative to the velocity of the plan
    double stiffness = 135;  // N/m, towards the position of the plan; above 0
    double resolution = 0;   // m: positions are quantised to it, as by an encoder; 0: exact
    double delay = 0;  // s from a write (that is, from the read before it) until the force acts; 1 at most
    // What its DeviceSpec says; the forces that act are not limited to that.
    float peak_force = 3.3f;     // N
    float lasting_force = 0.9f;  // N
    float stiffest_wall = 1000;  // N/m
};

/// A simulated person who yields to forces: a mass that a spring and a damper pull along a plan,
///     m x'' = k (plan - x) + c (plan' - x') + force.
/// Between two reads the force is constant and the plan linear, so the motion has a closed form: it is the
/// same at any rate, up to rounding. The plan's time counts from the first read, when the hand rests on it.
class VirtualHand final : public Device {
 public:
    explicit VirtualHand(Path plan, const VirtualHandSettings& settings = {});

    DeviceSpec spec() const override;
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;
    void stop() noexcept override;

    // For the thread that reads:
    dvec3 position() const { return position_; }  // m, at the last read, not quantised
    dvec3 velocity() const { return velocity_; }  // m/s
    vec3 force() const;                           // N, that acts now

 private:
    // A force, and how often the device had been stopped when it was written: a later stop() cancels it.
    struct Written {
        double from = 0;  // s since the first read
        vec3 force = vec3(0);
        unsigned stops = 0;
    };

    void advance(double until);
    void take_due();

    Path plan_;
    VirtualHandSettings settings_;
    std::optional<double> start_;  // on the loop's clock
    double time_ = 0;              // s since then
    dvec3 position_ = dvec3(0), velocity_ = dvec3(0);
    Written acting_;                // that acts
    std::vector<Written> waiting_;  // a ring buffer of the delayed forces, in order
    std::size_t first_ = 0, count_ = 0;
    std::atomic<unsigned> stops_ = 0;
};

}  // namespace palpate
