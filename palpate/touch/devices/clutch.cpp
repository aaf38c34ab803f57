#include "palpate/touch/devices/clutch.h"

#include <cmath>

namespace palpate {

Clutch::Clutch(std::unique_ptr<Device> inner, unsigned buttons)
    : Decorator(std::move(inner)), buttons_(buttons) {}

void Clutch::open() {
    known_ = let_go_ = false;
    offset_ = dvec3(0);
    Decorator::open();
}

bool Clutch::read(double now, DeviceState& state) noexcept {
    DeviceState real;
    if (!Decorator::read(now, real)) return false;
    // Ignores a place that is not finite: the offset would stay so for ever.
    const bool sound = std::isfinite(dot(real.pose.place, real.pose.place));
    const bool let_go = held_ || (real.buttons & buttons_) != 0;
    if (sound) {
        if (let_go_ && !let_go) {
            offset_ = at_.place - real.pose.place;
            ++placed_;
        }
        if (!let_go || !known_) at_ = {real.pose.place + offset_, real.pose.turn};
        known_ = true;
        let_go_ = let_go;
        real.pose = at_;
    }
    real.placed += placed_;
    state = real;
    return true;
}

bool Clutch::write(const Wrench& wrench) noexcept { return Decorator::write(let_go_ ? Wrench{} : wrench); }

}  // namespace palpate
