#pragma once
#include "palpate/base/vectors.h"

#include <string>

namespace palpate {

/// Where a hand is, as a device says.
struct Hand {
    vec3 position = vec3(0);  // m, in the scene
    double time = 0;  // s, on the loop's clock: when it was there, never later than now. Touch lets go of
                      // what is too old
    unsigned buttons = 0;  // a bit each, the first the lowest
    unsigned placed = 0;   // goes up by one when the position jumps because the device, a clutch or a scale
                           // was set anew and not because the hand went there: no force bridges such a jump
    // What a scale that was set since spec() was asked has changed: so many times as much a newton of the
    // scene is at the device now, and a metre of the device in the scene. Above 0; 1 where there is none.
    float forces = 1, motion = 1;
};

/// What a device can do.
struct DeviceSpec {
    std::string name = "a device";
    float peak_force = 3.3f;     // N, that it can push with for a moment
    float lasting_force = 0.9f;  // N, that it can push with for minutes without getting hot
    float stiffness = 1000;  // N/m, the stiffest wall that stays still on it; 1000 is usual for a desktop arm
    bool paces = false;      // its read() returns at the device's own ticks, which the loop then follows
};

/// A source of hand positions and a sink of forces. A driver is these five methods, in this tree or outside
/// (docs/extending.md); tests/touch/conformance.h is what every driver must pass.
class Device {
 public:
    virtual ~Device() = default;

    /// May be asked before it is open.
    virtual DeviceSpec spec() const = 0;

    /// Before anything below. May take its time. Throws Error that names the device and the remedy.
    virtual void open() = 0;

    /// Called by the loop, a thousand times a second: it may not wait (unless it paces), lock, allocate or
    /// open files. `now`: the loop's clock, s. False if the device is gone; then `hand` is as it was.
    virtual bool read(double now, Hand& hand) noexcept = 0;

    /// The force on the hand until the next call, N, in the scene, finite. Like read(); false if the device
    /// did not take it. Then it is stopped, at each tick until it does.
    virtual bool write(vec3 force) noexcept = 0;

    /// No force from now on until the next write(). May come from any thread at any time, also while read()
    /// or write() hangs in another, more than once, and when the device is gone; and from a handler of
    /// signals, in the middle of read() or write() on the same thread, so it is async-signal-safe.
    virtual void stop() noexcept = 0;
};

}  // namespace palpate
