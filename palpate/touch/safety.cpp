#include "palpate/touch/safety.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

bool is_finite(dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_factor(float factor) { return factor > 0 && std::isfinite(factor); }

bool is_finite(const Wrench& wrench) {
    return is_finite(dvec3(wrench.force)) && is_finite(dvec3(wrench.torque));
}

dvec3 no_longer_than(double most, dvec3 v) {
    const double length = glm::length(v);
    return length <= most ? v : most / length * v;
}

}  // namespace

bool is_sound(const DeviceState& state) {
    const bool turned = std::abs(glm::length(state.pose.turn) - 1) < 0.01;
    return is_finite(state.pose.place) && turned && std::isfinite(state.time) && is_factor(state.forces) &&
           is_factor(state.motion);
}

void check(const SafetySettings& settings, const std::string& device) {
    constexpr double any = std::numeric_limits<double>::max();
    constexpr double second = 1;  // no force lasts longer if everything else has failed
    struct Setting {
        const char* name;
        double value;
        bool may_be_zero = true;
        double most = any;
    };
    const SafetySettings& s = settings;
    const Setting all[] = {{"peak_force", s.peak_force},
                           {"lasting_force", s.lasting_force},
                           {"warm_up", s.warm_up},
                           {"slew_time", s.slew_time, false, second},
                           {"small_force", s.small_force},
                           {"calm", s.calm},
                           {"ramp", s.ramp},
                           {"fresh", s.fresh, true, second},
                           {"fade", s.fade, false, second},
                           {"fastest_hand", s.fastest_hand, false},
                           {"jump", s.jump, true, 1},
                           {"lost", s.lost, false, second},
                           {"store", s.store},
                           {"most_damping", s.most_damping}};
    static_assert(sizeof all / sizeof all[0] * sizeof(double) == sizeof settings, "each setting is checked");
    for (const Setting& one : all)
        if (!(one.may_be_zero ? one.value >= 0 : one.value > 0) || !(one.value <= one.most))
            throw Error(
                fmt::format("SafetySettings::{} is {}", one.name, one.value), device,
                fmt::format("give it {} zero{}", one.may_be_zero ? "at least" : "above",
                            one.most < any ? fmt::format(", and {} at most", one.most) : ", and finite"));
}

void check(const DeviceSpec& device) {
    struct Field {
        const char* name;
        float value;
        bool may_be_zero = false;
    };
    // A device with a peak torque must give a continuous one, too.
    const bool force_only = device.peak_torque == 0 && device.lasting_torque == 0;
    const Field all[] = {{"workspace", device.workspace},
                         {"peak_force", device.peak_force},
                         {"lasting_force", device.lasting_force},
                         {"peak_torque", device.peak_torque, force_only},
                         {"lasting_torque", device.lasting_torque, force_only},
                         {"stiffness", device.stiffness}};
    for (const Field& one : all)
        if (!(one.value > 0 || one.may_be_zero) || !std::isfinite(one.value))
            throw Error(fmt::format("DeviceSpec::{} is {}", one.name, one.value), device.name,
                        "its driver has to give a finite one above zero");
}

Safety::Safety(const DeviceSpec& device, const SafetySettings& settings, const Warmth& warmth)
    : device_force_{device.peak_force, device.lasting_force},
      device_torque_{device.peak_torque, device.lasting_torque},
      warmth_(warmth) {
    check(device);
    check(settings, device.name);
    const bool known = warmth.square >= 0 && std::isfinite(warmth.square) && std::isfinite(warmth.time);
    if (!known) throw Error("a warmth that is not a number", device.name, "give what Felt::warmth said");
    set(settings);
}

void Safety::set(const SafetySettings& settings) {
    auto no_more_than = [](double device, double wish) { return wish > 0 ? std::min(wish, device) : device; };
    settings_ = settings;
    force_.peak = no_more_than(device_force_.peak, settings.peak_force);
    force_.lasting = std::min(force_.peak, no_more_than(device_force_.lasting, settings.lasting_force));
    torque_.peak = device_torque_.peak * force_.peak / device_force_.peak;
    torque_.lasting = std::min(torque_.peak, device_torque_.lasting * force_.lasting / device_force_.lasting);
}

Wrench Safety::allow(const Wrench& wanted, const DeviceState& state, dvec3 velocity, dvec3 surface,
                     double now) {
    const double seconds = time_ ? now - *time_ : 0;
    time_ = now;
    warm(now);
    if (!calm_since_) calm_since_ = now;
    if (!(seconds >= 0 && seconds <= settings_.lost)) {
        let_go(Held::stalled);
        return none();
    }
    if (!is_finite(velocity)) velocity = dvec3(0);
    if (!is_finite(surface)) surface = dvec3(0);
    const bool sound = is_finite(wanted) && is_sound(state);
    // The limits are in the device's newtons and metres, not in the scene's.
    const double forces = sound ? double(state.forces) : 1;
    const double torques = sound ? forces / double(state.motion) : 1;
    double fresh = 0;
    if (sound) {
        watch(state, surface);
        // A sample from the future is on another clock, by which it would never be too old.
        const double age = now - state.time;
        if (age >= -settings_.fresh)
            fresh = std::clamp(1 - (age - settings_.fresh) / settings_.fade, 0.0, 1.0);
        if (!(fresh > 0)) let_go(Held::stale);
    } else {
        let_go(Held::not_finite);
    }
    gain_ = fresh > 0 ? grown(effort(wanted, 1, 1), now) : 0;
    part_ = gain_ * fresh;  // times 0, what is not finite is 0, too
    auto some_of = [this](vec3 all) { return part_ > 0 ? part_ * dvec3(all) : dvec3(0); };
    const dvec3 force = passivity_control(some_of(wanted.force), velocity - surface, seconds);
    allowed_ = {limited(force_, force, allowed_.force, forces, seconds),
                limited(torque_, some_of(wanted.torque), allowed_.torque, torques, seconds)};
    if (!is_finite(allowed_)) {  // huge numbers that overflow
        let_go(Held::not_finite);
        return none();
    }
    effort_ = effort(allowed_, forces, torques);
    return allowed_;
}

// Limits a force or a torque to the peak, to what the motors' warmth leaves of it, and to the slew rate.
// Heating is proportional to the square of the force, so its mean square is limited. From four fifths of the
// limit on, the peak is lowered gradually, so that the force does not break off. `scale`: to the device's
// units.
vec3 Safety::limited(const Limits& limits, dvec3 wanted, vec3 before, double scale, double seconds) const {
    const double over =
        std::clamp((warmth_.square / (force_.lasting * force_.lasting) - 0.8) / 0.2, 0.0, 1.0);
    const double peak = limits.peak / scale, most = peak + over * (limits.lasting / scale - peak);
    const dvec3 last(before);
    const dvec3 change = no_longer_than(most, wanted) - last;
    return vec3(no_longer_than(peak, last + no_longer_than(peak / settings_.slew_time * seconds, change)));
}

// The force that heats the motors as much as the wrench does, N at the device.
double Safety::effort(const Wrench& wrench, double forces, double torques) const {
    const double force = glm::length(dvec3(wrench.force)) * forces;
    const double torque = glm::length(dvec3(wrench.torque)) * torques;
    return torque_.peak > 0 ? std::max(force, torque * device_force_.lasting / device_torque_.lasting)
                            : force;
}

// Warms the motors by the force since the last call, also if that acted for too long.
void Safety::warm(double now) {
    if (!std::isfinite(now)) return;
    const double seconds = std::max(now - warmth_.time, 0.0);
    const double weight = settings_.warm_up > 0 ? 1 - std::exp(-seconds / settings_.warm_up) : 1;
    warmth_ = {warmth_.square + (effort_ * effort_ - warmth_.square) * weight, now};
}

void Safety::let_go(Held why) {
    part_ = 0;
    reason_ = why;
    waits_ = true;
    calm_since_ = time_;
    gain_ = 0;
    absorbed_ = 0;
    if (why == Held::placed) none();  // the old force belongs to another place
}

Held Safety::held() const {
    if (waits_) return reason_;
    return gain_ < 1 ? Held::ramping : Held::no;
}

// Checks that the hand has moved as a person can move it; and adds the work of the force to the passivity
// observer.
void Safety::watch(const DeviceState& state, dvec3 surface) {
    if (knows_place_) {
        const double seconds = std::max(state.time - before_.time, 0.0);
        const dvec3 went = state.pose.place - before_.pose.place;
        const double way = glm::length(went);
        const double work = glm::dot(dvec3(allowed_.force), went - seconds * surface);
        absorbed_ = std::min(absorbed_ - work, settings_.store);
        if (state.placed != before_.placed || state.forces != before_.forces ||
            state.motion != before_.motion)
            let_go(Held::placed);
        else if (way > settings_.jump && way > settings_.fastest_hand * seconds)
            let_go(Held::jumped);
    }
    before_ = state;
    knows_place_ = true;
}

// The gain of the ramp: 0 until little force is wanted, then up to 1.
double Safety::grown(double wanted, double now) {
    if (waits_) {
        if (wanted > settings_.small_force) {
            calm_since_ = now;
            return 0;
        }
        if (now - *calm_since_ < settings_.calm) return 0;
        waits_ = false;
        begun_ = now;
    }
    return settings_.ramp > 0 ? std::clamp((now - begun_) / settings_.ramp, 0.0, 1.0) : 1;
}

// Time-domain passivity control (Hannaford and Ryu 2002). A sampled surface generates a little energy each
// time the hand turns back, as no real one does; on a stiff surface that adds up to a buzz. A damper
// dissipates the energy that was generated since the touch began.
dvec3 Safety::passivity_control(dvec3 force, dvec3 velocity, double seconds) {
    if (glm::dot(force, force) == 0) {
        absorbed_ = 0;
        return force;
    }
    const double square = glm::dot(velocity, velocity);
    if (absorbed_ >= 0 || !(square > 1e-8) || !(seconds > 0)) return force;
    const double damping = std::min(-absorbed_ / (square * seconds), settings_.most_damping);
    return force - damping * velocity;
}

}  // namespace palpate
