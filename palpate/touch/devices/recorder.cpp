#include "palpate/touch/devices/recorder.h"

#include <cmath>

namespace palpate {

Recorder::Recorder(std::unique_ptr<Device> inner, double seconds, double rate) : Decorator(std::move(inner)) {
    constexpr double most = 1e9;  // ticks: many days
    if (!(seconds >= 0 && rate > 0 && seconds * rate <= most))
        throw Error("an invalid duration or rate of a recording", spec().name,
                    "give the duration in s and the rate in Hz, above 0");
    most_ = std::size_t(std::ceil(seconds * rate));
    log_.device = spec().name;
    log_.rate = rate;
    log_.ticks.reserve(most_);
}

bool Recorder::read(double now, DeviceState& state) noexcept {
    noted_ = false;
    if (!Decorator::read(now, state)) return false;
    noted_ = log_.ticks.size() < most_;
    if (noted_)
        log_.ticks.push_back({now, state, {}});
    else
        ++missed_;
    return true;
}

bool Recorder::write(const Wrench& wrench) noexcept {
    if (noted_) log_.ticks.back().wrench = wrench;
    return Decorator::write(wrench);
}

}  // namespace palpate
