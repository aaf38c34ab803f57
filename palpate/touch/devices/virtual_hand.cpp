#include "palpate/touch/devices/virtual_hand.h"

#include "palpate/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double most_delay = 1;         // s
constexpr double fastest_loop = 10'000;  // Hz: for so many delayed forces there is room

// The plan from a moment on: where it is, how fast, and for how long it goes on so.
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
        "a hand that cannot be", "give it a mass and a stiffness above 0 and a damping that is not below");
    require(s.resolution >= 0 && std::isfinite(s.resolution), "a resolution that is no length",
            "give it in m, or 0 for none");
    require(s.delay >= 0 && s.delay <= most_delay, "a delay that cannot be", "give it in s, from 0 to 1");
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
    // Only a loop faster than any finds no room. Then the newest gives way, so that the order stays.
    if (count_ == waiting_.size()) --count_;
    waiting_[(first_ + count_++) % waiting_.size()] = {
        time_ + settings_.delay, finite(wrench.force) ? wrench.force : vec3(0), stops_.load()};
    take_due();
    return true;
}

// A write that was under way when the device was stopped still bears the older count.
void VirtualHand::stop() noexcept { ++stops_; }

vec3 VirtualHand::force() const { return acting_.stops == stops_.load() ? acting_.force : vec3(0); }

// The forces whose time has come; the last of them acts.
void VirtualHand::take_due() {
    for (; count_ > 0 && waiting_[first_].from <= time_; --count_) {
        acting_ = waiting_[first_];
        first_ = (first_ + 1) % waiting_.size();
    }
}

// Piece by piece: until the plan bends or the next force comes.
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
