#pragma once
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"
#include "palpate/touch/device.h"

#include <optional>

namespace palpate {

/// Limits on the force on a hand; torques are limited in proportion. All are finite and at least zero;
/// brackets give further bounds.
struct SafetySettings {
    double peak_force = 0;     // N, at the device; 0: the peak force of the device
    double lasting_force = 0;  // N, the continuous force, for longer than about `warm_up`; 0: that of the
                               // device
    double warm_up = 10;       // s
    double slew_time = 0.008;  // s, in which force may rise to the peak or fall from it: the slew rate is
                               // peak / slew_time [above 0, up to 1]
    double small_force = 0.1;  // N, or an equivalent torque: only when no more is wanted for
    double calm = 0.02;        // s on end does force begin, and then
    double ramp = 1;           // s, it ramps up to what is wanted
    double fresh = 0.003;      // s: if the sample is older, the force fades out [up to 1]
    double fade = 0.020;       // s, within this time [above 0, up to 1]
    double fastest_hand = 3;   // m/s, and [above 0]
    double jump = 0.01;        // m: if the hand has moved farther and faster than these two, no person has
                               // moved it [up to 1]
    double lost = 0.008;       // s without a tick, after which everything known is too old: a stall [above 0,
                               // up to 1]
    double store = 0.02;       // J, the most absorbed energy with which the passivity observer credits a
                               // surface
    double most_damping = 5;   // N·s/m, the most damping that the passivity controller may add
};

/// Throws an Error that names a setting that is out of range; `device` is for the message.
void check(const SafetySettings& settings, const std::string& device);

/// Throws Error if a device's own limits are not positive and finite.
void check(const DeviceSpec& device);

/// How warm a device's motors are: a thermal model.
struct Warmth {
    double square = 0;  // N², at the device: the mean square of the force over about `warm_up`; a torque
                        // counts as the force that heats as much
    double time = 0;    // s, when that was computed
};

/// Why the force is reduced or zero.
enum class Held {
    no,          // the full force acts, within the limits
    waiting,     // it waits until the wanted force is small
    ramping,     // the force ramps up
    placed,      // the device, a clutch or a scale was repositioned
    jumped,      // the hand moved faster than a person can
    not_finite,  // a position or a force was not finite
    stale,       // the samples are too old
    gone,        // the device does not answer
    stalled,     // the loop stalled, and the watchdog stopped the device
    pushed,      // a surface appeared or jumped where the hand was
};

inline std::span<const Named<Held>> names(Held) {
    static constexpr Named<Held> all[] = {{Held::no, "no"},
                                          {Held::waiting, "waiting for a small force"},
                                          {Held::ramping, "ramping up"},
                                          {Held::placed, "set again"},
                                          {Held::jumped, "the hand jumped"},
                                          {Held::not_finite, "not a number"},
                                          {Held::stale, "old samples"},
                                          {Held::gone, "no device"},
                                          {Held::stalled, "the loop stalled"},
                                          {Held::pushed, "a surface came over the hand"}};
    return all;
}

/// Whether a sample is valid: everything is finite, its scale is above 0 and its orientation is a rotation.
bool is_sound(const DeviceState& state);

/// The safety limits between the wanted force and the device: peak and continuous force, slew rate, ramp,
/// fade-out, and passivity (observer and controller). Nothing passes that could hurt. It starts with no
/// force. Time is an argument, so it behaves the same on any clock.
class Safety {
 public:
    /// Throws Error like check(). `warmth`: of the motors, if they were used before.
    Safety(const DeviceSpec& device, const SafetySettings& settings, const Warmth& warmth = {});

    /// Sets new settings, which must have been checked; the warmth of the motors is kept.
    void set(const SafetySettings& settings);

    /// Limits the wanted wrench to what may be written now. `state`: the newest sample; `velocity`: of the
    /// hand, m/s; `surface`: the velocity of what it touches, m/s.
    Wrench allow(const Wrench& wanted, const DeviceState& state, dvec3 velocity, dvec3 surface, double now);

    /// Zero at once, as after the device was stopped.
    Wrench none() {
        effort_ = 0;
        return allowed_ = {};
    }

    /// Zero until little force is wanted, and then a new ramp.
    void let_go(Held why);

    /// Why the force is reduced now; and why it was let go the last time.
    Held held() const;
    Held last_reason() const { return reason_; }

    /// Which part of the wanted force acted at the last call, 0 to 1: of the ramp, and of the fade of old
    /// samples. Other limits came after.
    double part() const { return part_; }

    double peak_force() const { return force_.peak; }  // N, at the device
    const Warmth& warmth() const { return warmth_; }

 private:
    // Limits on force or torque, in the device's units.
    struct Limits {
        double peak, lasting;
    };
    void watch(const DeviceState& state, dvec3 surface);
    double grown(double wanted, double now);
    dvec3 passivity_control(dvec3 force, dvec3 velocity, double seconds);
    void warm(double now);
    double effort(const Wrench& wrench, double forces, double torques) const;
    vec3 limited(const Limits& limits, dvec3 wanted, vec3 before, double scale, double seconds) const;

    SafetySettings settings_;
    const Limits device_force_, device_torque_;  // of the device
    Limits force_, torque_;                      // that hold: N and N·m
    Held reason_ = Held::waiting;
    bool waits_ = true;
    std::optional<double> calm_since_;  // s, since when little has been wanted
    double begun_ = 0;                  // s, when the ramp began
    double gain_ = 0, part_ = 0;
    Warmth warmth_;
    double effort_ = 0;           // N, at the device, since the last call
    double absorbed_ = 0;         // J, the energy that the surface has absorbed since the touch began: the
                                  // passivity observer; below 0 it has generated energy
    std::optional<double> time_;  // of the last call
    DeviceState before_ = {};
    bool knows_place_ = false;
    Wrench allowed_ = {};
};

}  // namespace palpate
