#pragma once
#include "palpate/scene/path.h"
#include "palpate/touch/device.h"
#include "palpate/touch/devices/damped_spring.h"

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

namespace palpate {

/// A person's arm at the tip of a device, and the device. The defaults are what van Beek et al. (Scientific
/// Reports 5, 18004, 2015, the trial of figure 3) found of an arm that holds a force-feedback device.
struct VirtualHandSettings {
    double mass = 0.554;     // kg, above 0
    double damping = 6.45;   // N s/m, against the plan's velocity
    double stiffness = 135;  // N/m, towards the plan's place; above 0
    double resolution = 0;   // m: positions are read as multiples of it, as from an encoder; 0: as they are
    double delay = 0;  // s from a write, that is from the read before it, until the force acts; 1 at most
    // What its motors are said to do (DeviceSpec); they push as they are told.
    float peak_force = 3.3f;     // N
    float lasting_force = 0.9f;  // N
    float stiffest_wall = 1000;  // N/m
};

/// A simulated person whom forces push: mass, spring and damper that are pulled along a plan,
///     m x'' = k (plan - x) + c (plan' - x') + force.
/// Between two reads the force is constant and the plan straight, so the motion is known in closed form: it
/// is the same at any rate, to rounding. The plan counts from the first read, where the hand rests on it.
class VirtualHand final : public Device {
 public:
    explicit VirtualHand(Path plan, const VirtualHandSettings& settings = {});

    DeviceSpec spec() const override;
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;
    void stop() noexcept override;

    // On the thread that reads:
    dvec3 position() const { return position_; }  // m, at the last read, whatever the resolution
    dvec3 velocity() const { return velocity_; }  // m/s
    vec3 force() const;                           // N, that acts now

 private:
    // A force, and how often the device had been stopped when it was written: a later stop() makes it none.
    struct Written {
        double from = 0;  // s since the first read
        vec3 force = vec3(0);
        unsigned stops = 0;
    };

    void advance(double until);
    void take_due();

    Path plan_;
    VirtualHandSettings settings_;
    std::optional<double> start_;  // of the loop's clock
    double time_ = 0;              // s since then
    dvec3 position_ = dvec3(0), velocity_ = dvec3(0);
    Written acting_;                // that acts
    std::vector<Written> waiting_;  // a ring: the delayed ones, in their order
    std::size_t first_ = 0, count_ = 0;
    std::atomic<unsigned> stops_ = 0;
};

}  // namespace palpate
