#include "palpate/touch/devices/virtual_hand.h"

#include "palpate/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double most_delay = 1;         // s
constexpr double fastest_loop = 10'000;  // Hz: there is room for the delayed forces of such a loop

// The linear piece of the plan at a moment: position, velocity and end.
struct Course {
    dvec3 place, velocity;
    double until;  // s
};

Course course(const Path& plan, double time) {
    const auto next = std::upper_bound(plan.begin(), plan.end(), time,
                                       [](double t, const Waypoint& w) { return t < w.time; });
    if (next == plan.begin()) return {plan.front().position, dvec3(0), plan.front().time};
    if (next == plan.end()) return {plan.back().position, dvec3(0), std::numeric_limits<double>::infinity()};
    const dvec3 from = (next - 1)->position;
    const dvec3 velocity = (dvec3(next->position) - from) / (next->time - (next - 1)->time);
    return {from + velocity * (time - (next - 1)->time), velocity, next->time};
}

bool finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

VirtualHand::VirtualHand(Path plan, const VirtualHandSettings& settings)
    : plan_(std::move(plan)), settings_(settings) {}

DeviceSpec VirtualHand::spec() const {
    return {.name = "virtual hand",
            .peak_force = settings_.peak_force,
            .lasting_force = settings_.lasting_force,
            .stiffness = settings_.stiffest_wall};
}

void VirtualHand::open() {
    const VirtualHandSettings& s = settings_;
    auto require = [&](bool holds, const char* what, const char* remedy) {
        if (!holds) throw Error(what, "virtual hand", remedy);
    };
    check(plan_, "virtual hand");
    require(
        s.mass > 0 && s.stiffness > 0 && s.damping >= 0 && std::isfinite(s.mass + s.stiffness + s.damping),
        "an impossible hand", "give it a mass and a stiffness above 0 and a damping of at least 0");
    require(s.resolution >= 0 && std::isfinite(s.resolution), "an invalid resolution",
            "give it in m, or 0 for none");
    require(s.delay >= 0 && s.delay <= most_delay, "an invalid delay", "give it in s, from 0 to 1");
    waiting_.resize(std::size_t(s.delay * fastest_loop) + 2);
    first_ = count_ = 0;
    acting_ = {};
    start_.reset();
}

bool VirtualHand::read(double now, DeviceState& state) noexcept {
    if (!start_) {
        start_ = now;
        time_ = 0;
        position_ = course(plan_, 0).place;
        velocity_ = dvec3(0);
    }
    advance(now - *start_);
    const double grid = settings_.resolution;
    state = {.pose = {.place = grid > 0 ? grid * round(position_ / grid) : position_}, .time = now};
    return true;
}

bool VirtualHand::write(const Wrench& wrench) noexcept {
    // If a loop is even faster and there is no room, the newest force is dropped, which keeps the order.
    if (count_ == waiting_.size()) --count_;
    waiting_[(first_ + count_++) % waiting_.size()] = {
        time_ + settings_.delay, finite(wrench.force) ? wrench.force : vec3(0), stops_.load()};
    take_due();
    return true;
}

// A write that was under way when the device was stopped still has the older count.
void VirtualHand::stop() noexcept { ++stops_; }

vec3 VirtualHand::force() const { return acting_.stops == stops_.load() ? acting_.force : vec3(0); }

// Takes the forces that are due; the last of them acts.
void VirtualHand::take_due() {
    for (; count_ > 0 && waiting_[first_].from <= time_; --count_) {
        acting_ = waiting_[first_];
        first_ = (first_ + 1) % waiting_.size();
    }
}

// Advances piece by piece: to each corner of the plan and to each new force.
void VirtualHand::advance(double until) {
    const DampedSpring arm{settings_.stiffness / settings_.mass, settings_.damping / settings_.mass};
    while (time_ < until) {
        const Course plan = course(plan_, time_);
        const double next_force = count_ > 0 ? waiting_[first_].from : plan.until;
        const double end = std::min({until, plan.until, next_force});
        const dvec3 pushed_aside = dvec3(force()) / settings_.stiffness;
        const dvec3 rest = plan.place + pushed_aside;
        const Swing swing = after({position_ - rest, velocity_ - plan.velocity}, arm, end - time_);
        position_ = rest + plan.velocity * (end - time_) + swing.offset;
        velocity_ = plan.velocity + swing.velocity;
        time_ = end;
        take_due();
    }
}

}  // namespace palpate
