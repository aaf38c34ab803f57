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

// The direction to the right in a picture that looks along `forward`, as in the renderer, also if `up` is
// degenerate.
dvec3 rightward(dvec3 forward, dvec3 up) {
    const dvec3 right = cross(forward, up);
    if (dot(right, right) >= 1e-8) return normalize(right);
    return normalize(cross(forward, std::abs(forward.z) < 0.7 ? dvec3(0, 0, 1) : dvec3(1, 0, 0)));
}

}  // namespace

Mouse::Mouse(const MouseSettings& settings, std::vector<PointerEvent> replay)
    : settings_(settings), replay_(std::move(replay)) {
    next_input_.event.position = 0.5f * vec2(settings.size);
    next_input_.camera = settings.camera;
    next_input_.size = settings.size;
    shared_.store(next_input_);
}

void Mouse::point(const PointerEvent& event) noexcept {
    next_input_.event = event;
    ++next_input_.events;
    shared_.store(next_input_);
}

void Mouse::place(const PointerEvent& event) noexcept {
    next_input_.placed = event;
    ++next_input_.placings;
    point(event);
}

void Mouse::look(const Camera& camera, ivec2 size) noexcept {
    next_input_.camera = camera;
    next_input_.size = size;
    next_input_.placed = next_input_.event;
    ++next_input_.placings;
    shared_.store(next_input_);
}

void Mouse::open() {
    if (!(settings_.smoothing > 0 && std::isfinite(settings_.smoothing)))
        throw Error("a smoothing that is not a positive time", "mouse", "give it in s, above 0");
    if (!std::isfinite(settings_.notch)) throw Error("a notch that is not finite", "mouse", "give it in m");
    for (const PointerEvent& event : replay_)
        if (!std::isfinite(event.time)) throw Error("an event without a time", "mouse", "give it in s");
    const auto later = [](const PointerEvent& a, const PointerEvent& b) { return a.time < b.time; };
    if (!std::is_sorted(replay_.begin(), replay_.end(), later))
        throw Error("events that are not in order of time", "mouse", "sort them");
    input_ = shared_.load();
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
        Input input = input_;
        input.event = replay_[next_];
        take(input, *start_ + input.event.time, now, next_ == 0);
    }
    Input input = input_;
    if (shared_.try_load(input) && (input.events != input_.events || input.placings != input_.placings)) {
        const bool is_first = input_.events == 0 && input.placings == input_.placings;
        if (input.placings != input_.placings) {
            Input there = input;
            there.event = input.placed;
            take(there, there.event.time, now, true);
        }
        take(input, input.event.time, now, is_first);
    }
    advance(now);
    state = {.pose = {.place = target_ + swing_.offset},
             .time = now,
             .buttons = input_.event.buttons,
             .placed = placed_};
    return true;
}

// Sets the target of the hand at that time; or places the hand there, if it had no place before or the camera
// has moved.
void Mouse::take(const Input& input, double time, double now, bool placed) {
    advance(std::clamp(time, time_, now));
    const dvec3 from = target_;
    input_ = input;
    target_ = place();
    swing_.offset += from - target_;
    if (placed) {
        swing_ = {};
        ++placed_;
    }
}

void Mouse::advance(double time) {
    const double rate = 1 / settings_.smoothing;
    if (time > time_) swing_ = after(swing_, {.stiffness = rate * rate, .damping = 2 * rate}, time - time_);
    time_ = std::max(time_, time);
}

// The place under the pointer, along its line of sight.
dvec3 Mouse::place() const {
    const Camera& camera = input_.camera;
    const dvec3 eye = camera.eye, to = dvec3(camera.look_at) - eye;
    const dvec3 forward = unit(to, dvec3(0, 0, -1));
    const dvec3 right = rightward(forward, unit(camera.up, dvec3(0, 1, 0))), up = cross(right, forward);
    const double distance = std::max(length(to), 1e-3);
    const double angle = camera.angle >= 1 ? std::min(camera.angle, 170.0f) : 1.0f;
    const double slope = std::tan(0.5 * glm::radians(angle));

    const dvec2 half = 0.5 * dvec2(glm::max(input_.size, ivec2(1)));
    const dvec2 aside = (dvec2(input_.event.position) - half) / half.y * dvec2(1, -1) * slope;
    const double depth = std::max(distance + double(input_.event.wheel) * settings_.notch, 0.01 * distance);
    return eye + depth * forward +
           (camera.orthographic ? distance : depth) * (aside.x * right + aside.y * up);
}

}  // namespace palpate
