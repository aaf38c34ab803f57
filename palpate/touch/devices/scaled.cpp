#include "palpate/touch/devices/scaled.h"

#include "palpate/base/error.h"

#include <cmath>

namespace palpate {
namespace {

float forces(const Scale& scale) { return scale.forces > 0 ? scale.forces : 1 / scale.motion; }

// A torque is a force times a lever arm, which is a length.
float torques(const Scale& scale) { return forces(scale) / scale.motion; }

vec3 no_longer_than(float most, vec3 v) {
    const float size = length(v);
    return size > most ? v * (most / size) : v;
}

void check(const Scale& scale, const std::string& device) {
    const auto is_usable = [](float factor) { return factor >= 1e-6f && factor <= 1e6f; };
    if (!is_usable(scale.motion) || !(scale.forces == 0 || is_usable(scale.forces)) ||
        !std::isfinite(dot(scale.about, scale.about)))
        throw Error("a scale that is out of range", device, "give it a point and factors from 1e-6 to 1e6");
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
    spec.workspace *= first_.motion;
    spec.peak_force /= forces(first_);
    spec.lasting_force /= forces(first_);
    spec.peak_torque /= torques(first_);
    spec.lasting_torque /= torques(first_);
    spec.stiffness /= forces(first_) * first_.motion;
    return spec;
}

void Scaled::open() {
    peak_force_ = Decorator::spec().peak_force;
    peak_torque_ = Decorator::spec().peak_torque;
    Decorator::open();
}

bool Scaled::read(double now, DeviceState& state) noexcept {
    if (!Decorator::read(now, state)) return false;
    shared_.try_load(used_);  // otherwise at the next read
    const Scale& scale = used_.scale;
    const dvec3 about(scale.about);
    state.pose.place = about + double(scale.motion) * (state.pose.place - about);
    state.placed += used_.times;
    state.forces *= forces(scale) / forces(first_);
    state.motion *= scale.motion / first_.motion;
    return true;
}

bool Scaled::write(const Wrench& wrench) noexcept {
    const Scale& scale = used_.scale;
    return Decorator::write({no_longer_than(peak_force_, forces(scale) * wrench.force),
                             no_longer_than(peak_torque_, torques(scale) * wrench.torque)});
}

}  // namespace palpate
