#pragma once
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"
#include "palpate/touch/device.h"

#include <optional>

namespace palpate {

/// Limits on what a hand may be pushed with; torques are limited in proportion to forces. All are finite and
/// not below zero; in brackets what else.
struct SafetySettings {
    double peak_force = 0;     // N, at the device; 0: what that can do
    double lasting_force = 0;  // N, for longer than about `warm_up`; 0: what the device can
    double warm_up = 10;       // s
    double slew_time = 0.008;  // s, in which the peak may come or go: the slew rate is peak / slew_time
                               // [above 0, to 1]
    double small_force = 0.1;  // N, or as much torque: only when no more is wanted for
    double calm = 0.02;        // s without a break does force begin, and
    double ramp = 1;           // s, grows to what it shall be
    double fresh = 0.003;      // s: a sample that is older lets go, [to 1]
    double fade = 0.020;       // s, in so long [above 0, to 1]
    double fastest_hand = 3;   // m/s, and [above 0]
    double jump = 0.01;       // m: a hand that is farther on than both allow was not moved by a person [to 1]
    double lost = 0.008;      // s without a tick, after which all that is known is too old [above 0, to 1]
    double store = 0.02;      // J, that the passivity observer takes a surface to hold at most
    double most_damping = 5;  // N·s/m, that the passivity observer may add
};

/// Throws Error that names the setting which is out of bounds; `device` is for the message.
void check(const SafetySettings& settings, const std::string& device);

/// Throws Error if a device says of itself what no limit could be made of.
void check(const DeviceSpec& device);

/// How warm a device's motors are.
struct Warmth {
    double square = 0;  // N², at the device: the mean square of the force, over about `warm_up`; a torque
                        // counts as the force that warms them as much
    double time = 0;    // s, when that was
};

/// Why there is no force, or not all of it.
enum class Held {
    no,          // all that is wanted, within the limits
    waiting,     // for a small force to begin with
    ramping,     // it grows
    placed,      // the device, a clutch or a scale was set anew
    jumped,      // the hand was somewhere else at once
    not_finite,  // a position or a force was not a number
    stale,       // the samples are old
    gone,        // the device does not answer
    stalled,     // the loop did not come round, and the watchdog let go
    pushed,      // a surface appeared or jumped where the hand was
};

inline std::span<const Named<Held>> names(Held) {
    static constexpr Named<Held> all[] = {{Held::no, "no"},
                                          {Held::waiting, "waiting for a small force"},
                                          {Held::ramping, "ramping up"},
                                          {Held::placed, "set anew"},
                                          {Held::jumped, "the hand jumped"},
                                          {Held::not_finite, "not a number"},
                                          {Held::stale, "old samples"},
                                          {Held::gone, "no device"},
                                          {Held::stalled, "the loop stalled"},
                                          {Held::pushed, "a surface came over the hand"}};
    return all;
}

/// Whether all that a device says is finite, and its scale and turn are some.
bool is_sound(const DeviceState& state);

/// Stands between what a hand would feel and the device: the last word, which nothing passes that could hurt.
/// Starts with no force. Works on the time that it is given, so it behaves the same on any clock.
class Safety {
 public:
    /// Throws Error as check() does. `warmth`: of the motors, if they were used before.
    Safety(const DeviceSpec& device, const SafetySettings& settings, const Warmth& warmth = {});

    /// Other settings, that were checked; the motors stay as warm.
    void set(const SafetySettings& settings);

    /// What may be written now of what is wanted. `state`: the newest sample; `velocity`: of the hand, m/s;
    /// `surface`: of what it touches.
    Wrench allow(const Wrench& wanted, const DeviceState& state, dvec3 velocity, dvec3 surface, double now);

    /// Nothing at once, as after the device was stopped.
    Wrench none() {
        effort_ = 0;
        return allowed_ = {};
    }

    /// Nothing until little is wanted, and then a new ramp.
    void let_go(Held why);

    /// Why there is no force or not all, now; and why it was let go of the last time.
    Held held() const;
    Held last_reason() const { return reason_; }

    double peak_force() const { return force_.peak; }  // N, at the device
    const Warmth& warmth() const { return warmth_; }

 private:
    // What a device can, or may, of forces or of torques; in its own units.
    struct Limits {
        double peak, lasting;
    };
    void watch(const DeviceState& state, dvec3 surface);
    double grown(double wanted, double now);
    dvec3 passive(dvec3 force, dvec3 velocity, double seconds);
    void warm(double now);
    double effort(const Wrench& wrench, double forces, double torques) const;
    vec3 limited(const Limits& limits, dvec3 wanted, vec3 before, double scale, double seconds) const;

    SafetySettings settings_;
    const Limits device_force_, device_torque_;  // that the device can
    Limits force_, torque_;                      // that are allowed: N and N·m
    Held reason_ = Held::waiting;
    bool waits_ = true;
    std::optional<double> calm_since_;  // s, when little began to be wanted
    double begun_ = 0;                  // s, when the ramp began
    double gain_ = 0;
    Warmth warmth_;
    double effort_ = 0;           // N, at the device, since the last call
    double absorbed_ = 0;         // J, from the hand since the touch began; below 0 it was given out
    std::optional<double> time_;  // of the last call
    DeviceState before_ = {};
    bool knows_place_ = false;
    Wrench allowed_ = {};
};

}  // namespace palpate
