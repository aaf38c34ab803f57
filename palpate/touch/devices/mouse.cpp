#include "palpate/touch/devices/mouse.h"

#include "palpate/base/error.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

dvec3 unit(dvec3 v, dvec3 otherwise) {
    const double squared = dot(v, v);
    return std::isfinite(squared) && squared > 1e-30 ? v / std::sqrt(squared) : otherwise;
}

// To the right in a picture that looks along `forward`; as the renderer has it, also where `up` says nothing.
dvec3 rightward(dvec3 forward, dvec3 up) {
    const dvec3 right = cross(forward, up);
    if (dot(right, right) >= 1e-8) return normalize(right);
    return normalize(cross(forward, std::abs(forward.z) < 0.7 ? dvec3(0, 0, 1) : dvec3(1, 0, 0)));
}

}  // namespace

Mouse::Mouse(const MouseSettings& settings, std::vector<PointerEvent> replay)
    : settings_(settings), replay_(std::move(replay)) {
    telling_.event.position = 0.5f * vec2(settings.size);
    telling_.camera = settings.camera;
    telling_.size = settings.size;
    shared_.store(telling_);
}

void Mouse::point(const PointerEvent& event) noexcept {
    telling_.event = event;
    ++telling_.events;
    shared_.store(telling_);
}

void Mouse::place(const PointerEvent& event) noexcept {
    telling_.placed = event;
    ++telling_.placings;
    point(event);
}

void Mouse::look(const Camera& camera, ivec2 size) noexcept {
    telling_.camera = camera;
    telling_.size = size;
    telling_.placed = telling_.event;
    ++telling_.placings;
    shared_.store(telling_);
}

void Mouse::open() {
    if (!(settings_.smoothing > 0 && std::isfinite(settings_.smoothing)))
        throw Error("a smoothing that is no time", "mouse", "give it in s, above 0");
    if (!std::isfinite(settings_.notch)) throw Error("a notch that is no length", "mouse", "give it in m");
    for (const PointerEvent& event : replay_)
        if (!std::isfinite(event.time)) throw Error("an event without a time", "mouse", "give it in s");
    const auto later = [](const PointerEvent& a, const PointerEvent& b) { return a.time < b.time; };
    if (!std::is_sorted(replay_.begin(), replay_.end(), later))
        throw Error("events that go back in time", "mouse", "sort them");
    told_ = shared_.load();
    start_.reset();
    next_ = 0;
}

bool Mouse::read(double now, DeviceState& state) noexcept {
    if (!start_) {
        start_ = time_ = now;
        target_ = place();
        swing_ = {};
    }
    for (; next_ < replay_.size() && *start_ + replay_[next_].time <= now; ++next_) {
        Told told = told_;
        told.event = replay_[next_];
        take(told, *start_ + told.event.time, now, next_ == 0);
    }
    Told told = told_;
    if (shared_.try_load(told) && (told.events != told_.events || told.placings != told_.placings)) {
        const bool is_first = told_.events == 0 && told.placings == told_.placings;
        if (told.placings != told_.placings) {
            Told there = told;
            there.event = told.placed;
            take(there, there.event.time, now, true);
        }
        take(told, told.event.time, now, is_first);
    }
    advance(now);
    state = {.pose = {.place = target_ + swing_.offset},
             .time = now,
             .buttons = told_.event.buttons,
             .placed = placed_};
    return true;
}

// The hand turns to what it is told, at that time; or is placed there, if it was nowhere before or is seen
// from elsewhere.
void Mouse::take(const Told& told, double time, double now, bool anew) {
    advance(std::clamp(time, time_, now));
    const dvec3 from = target_;
    told_ = told;
    target_ = place();
    swing_.offset += from - target_;
    if (anew) {
        swing_ = {};
        ++placed_;
    }
}

void Mouse::advance(double time) {
    const double rate = 1 / settings_.smoothing;
    if (time > time_) swing_ = after(swing_, {.stiffness = rate * rate, .damping = 2 * rate}, time - time_);
    time_ = std::max(time_, time);
}

// Under the pointer, along its line of sight.
dvec3 Mouse::place() const {
    const Camera& camera = told_.camera;
    const dvec3 eye = camera.eye, to = dvec3(camera.look_at) - eye;
    const dvec3 forward = unit(to, dvec3(0, 0, -1));
    const dvec3 right = rightward(forward, unit(camera.up, dvec3(0, 1, 0))), up = cross(right, forward);
    const double distance = std::max(length(to), 1e-3);
    const double angle = camera.angle >= 1 ? std::min(camera.angle, 170.0f) : 1.0f;
    const double slope = std::tan(0.5 * glm::radians(angle));

    const dvec2 half = 0.5 * dvec2(glm::max(told_.size, ivec2(1)));
    const dvec2 aside = (dvec2(told_.event.position) - half) / half.y * dvec2(1, -1) * slope;
    const double depth = std::max(distance + double(told_.event.wheel) * settings_.notch, 0.01 * distance);
    return eye + depth * forward +
           (camera.orthographic ? distance : depth) * (aside.x * right + aside.y * up);
}

}  // namespace palpate
