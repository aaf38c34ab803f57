#include "palpate/touch/devices/scaled.h"

#include "palpate/base/error.h"

#include <cassert>
#include <cmath>

namespace palpate {
namespace {

float forces(const Scale& scale) { return scale.forces > 0 ? scale.forces : 1 / scale.motion; }

bool usable(const Scale& scale) {
    return scale.motion > 0 && scale.forces >= 0 && std::isfinite(scale.motion + scale.forces) &&
           std::isfinite(dot(scale.about, scale.about));
}

}  // namespace

Scaled::Scaled(std::unique_ptr<Device> inner, const Scale& scale)
    : Decorator(std::move(inner)), first_(scale), setting_{scale}, shared_(setting_), used_(setting_) {}

void Scaled::set(const Scale& scale) noexcept {
    assert(usable(scale));
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
    const DeviceSpec spec = Decorator::spec();
    if (!usable(first_)) throw Error("a scale that cannot be", spec.name, "give it factors above 0");
    peak_force_ = spec.peak_force;
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
    return true;
}

bool Scaled::write(vec3 force) noexcept {
    force *= forces(used_.scale);
    const float size = length(force);
    return Decorator::write(size > peak_force_ ? force * (peak_force_ / size) : force);
}

}  // namespace palpate
