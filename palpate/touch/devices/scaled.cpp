#include "palpate/touch/devices/scaled.h"

#include "palpate/base/error.h"

#include <cmath>

namespace palpate {
namespace {

float forces(const Scale& scale) { return scale.forces > 0 ? scale.forces : 1 / scale.motion; }

void check(const Scale& scale, const std::string& device) {
    const auto is_usable = [](float factor) { return factor >= 1e-6f && factor <= 1e6f; };
    if (!is_usable(scale.motion) || !(scale.forces == 0 || is_usable(scale.forces)) ||
        !std::isfinite(dot(scale.about, scale.about)))
        throw Error("a scale that cannot be", device, "give it a point and factors from 1e-6 to 1e6");
}

}  // namespace

Scaled::Scaled(std::unique_ptr<Device> inner, const Scale& scale)
    : Decorator(std::move(inner)), first_(scale), setting_{scale}, shared_(setting_), used_(setting_) {
    check(first_, Decorator::spec().name);
}

void Scaled::set(const Scale& scale) {
    check(scale, Decorator::spec().name);
    setting_.scale = scale;
    ++setting_.times;
    shared_.store(setting_);
}

DeviceSpec Scaled::spec() const {
    DeviceSpec spec = Decorator::spec();
    spec.peak_force /= forces(first_);
    spec.lasting_force /= forces(first_);
    spec.stiffness /= forces(first_) * first_.motion;
    return spec;
}

void Scaled::open() {
    peak_force_ = Decorator::spec().peak_force;
    Decorator::open();
}

bool Scaled::read(double now, Hand& hand) noexcept {
    Hand real;
    if (!Decorator::read(now, real)) return false;
    shared_.try_load(used_);  // else the next time
    const Scale& scale = used_.scale;
    hand = real;
    hand.position = scale.about + scale.motion * (real.position - scale.about);
    hand.placed += used_.times;
    hand.forces *= forces(scale) / forces(first_);
    hand.motion *= scale.motion / first_.motion;
    return true;
}

bool Scaled::write(vec3 force) noexcept {
    force *= forces(used_.scale);
    const float size = length(force);
    return Decorator::write(size > peak_force_ ? force * (peak_force_ / size) : force);
}

}  // namespace palpate
