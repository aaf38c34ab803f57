#pragma once
#include "palpate/base/pose.h"

#include <string>

namespace palpate {

/// What pushes and turns a hand, in the scene's axes; about the place of the device's tip.
struct Wrench {
    vec3 force = vec3(0);   // N
    vec3 torque = vec3(0);  // N·m

    bool operator==(const Wrench&) const = default;
};

/// What a device says at one moment.
struct DeviceState {
    Pose pose = {};   // of its tip, in the scene; a device without DeviceSpec::turns leaves it unturned
    double time = 0;  // s, on the loop's clock: when it was there, never later than now. Touch lets go of
                      // what is too old
    unsigned buttons = 0;  // a bit each, the first the lowest
    unsigned placed = 0;   // goes up by one when the pose jumps because the device, a clutch or a scale was
                           // set anew and not because the hand went there: no force bridges such a jump
    // What a scale that was set since spec() was asked has changed: so many times as much a newton of the
    // scene is at the device now, and a metre of the device in the scene. Above 0; 1 where there is none.
    float forces = 1, motion = 1;
};

/// What a device can do.
struct DeviceSpec {
    std::string name = "a device";
    float workspace = 0.2f;      // m, across the room in which its tip can go
    float peak_force = 3.3f;     // N, that it can push with for a moment
    float lasting_force = 0.9f;  // N, that it can push with for minutes without getting hot
    float peak_torque = 0;       // N·m, likewise; 0: it turns nobody,
    float lasting_torque = 0;    // and then this is 0 too
    float stiffness = 1000;  // N/m, the stiffest wall that stays still on it; 1000 is usual for a desktop arm
    bool turns = false;      // it says how its tip is turned
    bool dead_man = false;   // it has a switch that takes all force away once nobody holds it
    bool paces = false;      // its read() returns at the device's own ticks, which the loop then follows
};

/// Says where a hand is and pushes it. A driver is these five methods, in this tree or outside
/// (docs/extending.md); tests/touch/conformance.h is what every driver must pass.
class Device {
 public:
    virtual ~Device() = default;

    /// May be asked before it is open.
    virtual DeviceSpec spec() const = 0;

    /// Before anything below. May take its time. Throws Error that names the device and the remedy.
    virtual void open() = 0;

    /// Called by the loop, a thousand times a second: it may not wait (unless it paces), lock, allocate or
    /// open files. `now`: the loop's clock, s. False if the device is gone; then `state` is as it was.
    virtual bool read(double now, DeviceState& state) noexcept = 0;

    /// What acts on the hand until the next call, finite. Like read(); false if the device did not take it.
    /// Then it is stopped, at each tick until it does.
    virtual bool write(const Wrench& wrench) noexcept = 0;

    /// No force and no torque from now on until the next write(). May come from any thread at any time, also
    /// while read() or write() hangs in another, more than once, and when the device is gone; and from a
    /// handler of signals, in the middle of read() or write() on the same thread, so it is
    /// async-signal-safe.
    virtual void stop() noexcept = 0;
};

}  // namespace palpate
