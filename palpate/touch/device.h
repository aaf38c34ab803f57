#pragma once
#include "palpate/base/pose.h"

#include <string>

namespace palpate {

/// A wrench on a hand: force and torque about the device's tip, in the scene's axes.
struct Wrench {
    vec3 force = vec3(0);   // N
    vec3 torque = vec3(0);  // N·m

    bool operator==(const Wrench&) const = default;
};

/// One sample of a device.
struct DeviceState {
    Pose pose = {};   // of its tip, in the scene; a device without DeviceSpec::turns leaves it unturned
    double time = 0;  // s, on the loop's clock: when it was sampled, never later than now. Touch applies no
                      // force if it is too old
    unsigned buttons = 0;  // one bit each, the first button the lowest
    unsigned placed = 0;   // goes up by one when the pose jumps without a motion of the hand, because the
                           // device, a clutch or a scale was repositioned: no force acts across such a jump
    // What a scale has changed since spec() was called: newtons at the device per newton in the scene, and
    // metres in the scene per metre at the device. Above 0; 1 without a scale.
    float forces = 1, motion = 1;
};

/// The properties of a device.
struct DeviceSpec {
    std::string name = "a device";
    float workspace = 0.2f;      // m, the width of the space in which its tip can move
    float peak_force = 3.3f;     // N, the greatest force for a moment
    float lasting_force = 0.9f;  // N, the greatest continuous force: for minutes, without overheating
    float peak_torque = 0;       // N·m, likewise; 0: it has no torque,
    float lasting_torque = 0;    // and then this is 0 too
    float stiffness = 1000;      // N/m, the stiffest virtual wall that it renders without vibrating; 1000 is
                                 // usual for a desktop arm
    bool turns = false;          // it measures orientation
    bool dead_man_switch = false;  // it has a dead-man switch, which takes all force away once no one holds
                                   // it
    bool paces = false;            // its read() blocks until the device's own servo tick, which the loop then
                                   // follows
};

/// A haptic device: measures where a hand is and pushes it. A driver implements these five methods, in this
/// tree or outside (docs/extending.md), and must pass tests/touch/conformance.h.
class Device {
 public:
    virtual ~Device() = default;

    /// May be called before open().
    virtual DeviceSpec spec() const = 0;

    /// Is called before anything below. May take long. Throws an Error that names the device and the remedy.
    virtual void open() = 0;

    /// Called by the servo loop, a thousand times a second: it must not wait (unless it paces), lock,
    /// allocate or open files. `now`: the loop's clock, s. False if the device is gone; then `state` is
    /// unchanged.
    virtual bool read(double now, DeviceState& state) noexcept = 0;

    /// Applies a finite wrench to the hand until the next call, with the same limits as read(). False if the
    /// device did not accept it: then the loop calls stop(), at each tick until it does.
    virtual bool write(const Wrench& wrench) noexcept = 0;

    /// Sets force and torque to zero until the next write(). May be called from any thread at any time,
    /// repeatedly, also while read() or write() hangs in another, and when the device is gone; and from a
    /// signal handler that interrupts read() or write() on the same thread, so it must be async-signal-safe.
    virtual void stop() noexcept = 0;
};

}  // namespace palpate
