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

bool is_sound(dvec3 wanted, const Hand& hand) {
    return is_finite(wanted) && is_finite(dvec3(hand.position)) && std::isfinite(hand.time) &&
           is_factor(hand.forces) && is_factor(hand.motion);
}

dvec3 no_longer_than(double most, dvec3 v) {
    const double length = glm::length(v);
    return length <= most ? v : most / length * v;
}

}  // namespace

void check(const SafetySettings& settings, const std::string& device) {
    constexpr double any = std::numeric_limits<double>::max();
    constexpr double second = 1;  // no force goes on for longer after all else has failed
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
                           {"fall", s.fall, false, second},
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
    const std::pair<const char*, float> all[] = {{"peak_force", device.peak_force},
                                                 {"lasting_force", device.lasting_force},
                                                 {"stiffness", device.stiffness}};
    for (const auto& [name, value] : all)
        if (!(value > 0) || !std::isfinite(value))
            throw Error(fmt::format("DeviceSpec::{} is {}", name, value), device.name,
                        "its driver has to give a finite one above zero");
}

Safety::Safety(const DeviceSpec& device, const SafetySettings& settings, const Warmth& warmth)
    : device_peak_(device.peak_force), device_lasting_(device.lasting_force), warmth_(warmth) {
    check(device);
    check(settings, device.name);
    const bool known = warmth.square >= 0 && std::isfinite(warmth.square) && std::isfinite(warmth.time);
    if (!known) throw Error("a warmth that is no number", device.name, "give what Felt::warmth said");
    set(settings);
}

void Safety::set(const SafetySettings& settings) {
    auto no_more_than = [](double device, double wish) { return wish > 0 ? std::min(wish, device) : device; };
    settings_ = settings;
    peak_ = no_more_than(device_peak_, settings.peak_force);
    lasting_ = std::min(peak_, no_more_than(device_lasting_, settings.lasting_force));
}

dvec3 Safety::allow(dvec3 wanted, const Hand& hand, dvec3 velocity, dvec3 surface, double now) {
    const double seconds = time_ ? now - *time_ : 0;
    time_ = now;
    warm(now);
    if (!calm_since_) calm_since_ = now;
    if (!(seconds >= 0 && seconds <= settings_.lost)) {
        let_go(Held::stalled);
        return none();
    }
    double fresh = 0;
    if (!is_finite(velocity)) velocity = dvec3(0);
    if (!is_finite(surface)) surface = dvec3(0);
    if (is_sound(wanted, hand)) {
        watch(hand, surface);
        // One from the future has a clock of its own, by which it would never grow old.
        const double age = now - hand.time;
        if (age >= -settings_.fresh)
            fresh = std::clamp(1 - (age - settings_.fresh) / settings_.fade, 0.0, 1.0);
        if (!(fresh > 0)) let_go(Held::stale);
    } else {
        let_go(Held::not_finite);
        wanted = dvec3(0);
    }
    gain_ = fresh > 0 ? grown(glm::length(wanted), now) : 0;
    dvec3 force = passive(gain_ * fresh * wanted, velocity - surface, seconds);
    // The limits are the device's, so they are in newtons there.
    const double there = is_factor(hand.forces) ? double(hand.forces) : 1;
    force = no_longer_than(budget() / there, force);
    force = force_ + no_longer_than(peak_ / there / settings_.fall * seconds, force - force_);
    force_ = no_longer_than(peak_ / there, force);
    if (!is_finite(force_)) {  // numbers so large that they are none together
        let_go(Held::not_finite);
        return none();
    }
    pushes_ = glm::length(force_) * there;
    return force_;
}

// By what was pushed with until now, also if that was for longer than it should have been.
void Safety::warm(double now) {
    if (!std::isfinite(now)) return;
    const double seconds = std::max(now - warmth_.time, 0.0);
    const double weight = settings_.warm_up > 0 ? 1 - std::exp(-seconds / settings_.warm_up) : 1;
    warmth_ = {warmth_.square + (pushes_ * pushes_ - warmth_.square) * weight, now};
}

void Safety::let_go(Held why) {
    reason_ = why;
    waits_ = true;
    calm_since_ = time_;
    gain_ = 0;
    absorbed_ = 0;
    if (why == Held::placed) none();  // it belongs to another place
}

Held Safety::held() const {
    if (waits_) return reason_;
    return gain_ < 1 ? Held::ramping : Held::no;
}

// Whether the hand went where it is, as hands go; and what the force that was written did on its way.
void Safety::watch(const Hand& hand, dvec3 surface) {
    if (knows_hand_) {
        const double seconds = std::max(hand.time - before_.time, 0.0);
        const dvec3 went = dvec3(hand.position) - dvec3(before_.position);
        const double way = glm::length(went);
        absorbed_ = std::min(absorbed_ - glm::dot(force_, went - seconds * surface), settings_.store);
        if (hand.placed != before_.placed || hand.forces != before_.forces || hand.motion != before_.motion)
            let_go(Held::placed);
        else if (way > settings_.jump && way > settings_.fastest_hand * seconds)
            let_go(Held::jumped);
    }
    before_ = hand;
    knows_hand_ = true;
}

// From nothing, once little is wanted, to all.
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

// A surface that is sampled gives out a little energy at each turn of the hand, as no real one does; on a
// stiff one it adds up to a buzz. What has been given out beyond what was put in is taken back by a damper
// (Hannaford and Ryu 2002). It counts from when the touch began.
dvec3 Safety::passive(dvec3 force, dvec3 velocity, double seconds) {
    if (glm::dot(force, force) == 0) {
        absorbed_ = 0;
        return force;
    }
    const double square = glm::dot(velocity, velocity);
    if (absorbed_ >= 0 || !(square > 1e-8) || !(seconds > 0)) return force;
    const double damping = std::min(-absorbed_ / (square * seconds), settings_.most_damping);
    return force - damping * velocity;
}

// A motor's heat goes with the square of its force: the mean of that is held to what it can stand. From four
// fifths of it on the peak comes down, so that force does not break off.
double Safety::budget() const {
    const double over = std::clamp((warmth_.square / (lasting_ * lasting_) - 0.8) / 0.2, 0.0, 1.0);
    return peak_ + over * (lasting_ - peak_);
}

}  // namespace palpate
