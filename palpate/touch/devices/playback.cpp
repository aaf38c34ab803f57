#include "palpate/touch/devices/playback.h"

#include "palpate/base/error.h"

#include <algorithm>
#include <cmath>

namespace palpate {

Playback::Playback(Log log) : log_(std::move(log)) {}

void Playback::open() {
    if (log_.ticks.empty()) throw Error("a log without ticks", log_.device, "record some ticks");
    for (std::size_t i = 0; i < log_.ticks.size(); ++i) {
        const Tick& tick = log_.ticks[i];
        const bool rises = i == 0 || tick.now >= log_.ticks[i - 1].now;
        if (!std::isfinite(tick.now) || !std::isfinite(tick.state.time) || !rises)
            throw Error("a log whose times are not in order", log_.device, "sort its ticks");
    }
    later_.reset();
    at_ = 0;
}

bool Playback::read(double now, DeviceState& state) noexcept {
    const auto& ticks = log_.ticks;
    if (!later_) later_ = now - ticks.front().now;
    const double then = now - *later_;
    while (at_ + 1 < ticks.size() && ticks[at_ + 1].now <= then) ++at_;

    const Tick& last = ticks[at_];
    const bool over = at_ + 1 == ticks.size();
    const Tick& next = over ? last : ticks[at_ + 1];
    const double part = over ? 0 : (then - last.now) / (next.now - last.now);
    state = last.state;
    if (part > 0 && next.state.placed == last.state.placed) {
        const Pose &from = last.state.pose, &to = next.state.pose;
        state.pose = {glm::mix(from.place, to.place, part), glm::slerp(from.turn, to.turn, part)};
    }
    // With the age that the samples had then; after the last, with the age of that one.
    const double sampled =
        over ? last.state.time + (then - last.now) : glm::mix(last.state.time, next.state.time, part);
    state.time = std::min(sampled + *later_, now);
    return true;
}

}  // namespace palpate
