#include "palpate/touch/devices/recorder.h"

#include "palpate/base/error.h"

#include <cmath>

namespace palpate {

namespace {

std::size_t most_ticks(double seconds, double rate) {
    const double ticks = std::ceil(seconds * rate);
    if (!(seconds >= 0 && rate > 0 && ticks < 1e8))
        throw Error("a time or a rate below zero, or too long a time", "the recorder of a device",
                    "give it seconds, and ticks a second, of which 100 million are too many");
    return std::size_t(ticks);
}

}  // namespace

Recorder::Recorder(std::unique_ptr<Device> inner, double seconds, double rate)
    : Decorator(std::move(inner)), most_(most_ticks(seconds, rate)) {
    log_.device = spec().name;
    log_.rate = rate;
    log_.ticks.reserve(most_);
}

bool Recorder::read(double now, Hand& hand) noexcept {
    noted_ = false;
    if (!Decorator::read(now, hand)) return false;
    noted_ = log_.ticks.size() < most_;
    if (noted_)
        log_.ticks.push_back({now, hand, vec3(0)});
    else
        ++missed_;
    return true;
}

bool Recorder::write(vec3 force) noexcept {
    if (noted_) log_.ticks.back().force = force;
    return Decorator::write(force);
}

}  // namespace palpate
