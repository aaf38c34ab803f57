#include "palpate/touch/devices/clutch.h"

#include <cmath>

namespace palpate {

Clutch::Clutch(std::unique_ptr<Device> inner, unsigned buttons)
    : Decorator(std::move(inner)), buttons_(buttons) {}

void Clutch::open() {
    known_ = let_go_ = false;
    offset_ = vec3(0);
    Decorator::open();
}

bool Clutch::read(double now, Hand& hand) noexcept {
    Hand real;
    if (!Decorator::read(now, real)) return false;
    // A position that is no number goes by: an offset to it would never end.
    const bool sound = std::isfinite(dot(real.position, real.position));
    const bool let_go = held_ || (real.buttons & buttons_) != 0;
    if (sound) {
        if (let_go_ && !let_go) {
            offset_ = at_ - real.position;
            ++placed_;
        }
        if (!let_go || !known_) at_ = real.position + offset_;
        known_ = true;
        let_go_ = let_go;
        real.position = at_;
    }
    real.placed += placed_;
    hand = real;
    return true;
}

bool Clutch::write(vec3 force) noexcept { return Decorator::write(let_go_ ? vec3(0) : force); }

}  // namespace palpate
