#include "palpate/run/felt_hand.h"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

constexpr double shortest = 1e-4, longest = 0.5;  // s: over which a velocity can be measured
constexpr float deepest = 1.2f;                   // in radii of the tip

// m/s, one for each vertex; none if unknown.
void measure(std::vector<vec3>& speeds, const std::vector<vec3>& from, const std::vector<vec3>& to,
             double seconds) {
    if (from.size() != to.size() || seconds > longest || from == to) return speeds.clear();
    speeds.resize(to.size());
    const float rate = float(1 / seconds);
    for (std::size_t i = 0; i < to.size(); ++i) speeds[i] = rate * (to[i] - from[i]);
}

}  // namespace

FeltHand::FeltHand(std::unique_ptr<Device> device, TouchSettings settings, vec3 start, const Warmth& warmth)
    : touch_(std::move(device), std::move(settings), warmth), start_(start) {}

void FeltHand::feel(const std::vector<Skin>& skins, double time, float reach, const Simulated& simulated,
                    std::optional<double> moved_for) {
    felt_ = touch_.felt();
    before_.resize(skins.size());
    speeds_.resize(skins.size());
    const double seconds = std::max(moved_for.value_or(time - before_time_), shortest);
    std::vector<Touchable> surfaces;
    for (std::size_t s = 0; s < skins.size(); ++s) {
        const Skin& skin = skins[s];
        measure(speeds_[s], before_[s], skin.positions, seconds);
        surfaces.push_back({skin.positions, *skin.triangles, speeds_[s], skin.is_sheet, skin.numbers});
    }
    const vec3 around = felt_.time > 0 ? felt_.proxy : start_;
    touch_.feel(maker_.next(surfaces, around, reach, time), simulated);
    for (std::size_t s = 0; s < skins.size(); ++s) before_[s] = skins[s].positions;
    before_time_ = time;
    // The old dents can only be removed once the touch has the new surfaces.
    if (begins_anew_) touch_.begin_anew();
    begins_anew_ = jumps_ = false;
}

void FeltHand::begin_anew() {
    expect_jump();
    begins_anew_ = true;
}

void FeltHand::tick(double now) {
    touch_.tick(now);
    felt_ = touch_.felt();
}

vec3 FeltHand::place() const {
    if (felt_.time == 0) return start_;
    const vec3 way = vec3(felt_.pose.place) - felt_.proxy;
    const float length = glm::length(way), most = deepest * radius();
    return felt_.proxy + (length > most ? most / length : 1) * way;
}

// A device that was placed somewhere else did not move there.
Press FeltHand::press(double seconds, std::size_t bodies) {
    const bool jumped = felt_.placed != std::exchange(placed_, felt_.placed);
    const vec3 to = place(), from = jumped ? to : pressed_from_.value_or(to);
    pressed_from_ = to;
    const std::span all(touch_.settings().feels.data(), bodies);  // as the device can render it
    const bool touches_body = felt_.surface >= 0 && std::size_t(felt_.surface) < bodies;
    const Feel feel = touches_body ? all[std::size_t(felt_.surface)]
                      : bodies > 0 ? *std::ranges::max_element(all, {}, &Feel::stiffness)
                                   : Feel{};
    return {.centre = from,
            .velocity = (to - from) / float(seconds),
            .radius = radius(),
            .stiffness = felt_.part * float(feel.stiffness),
            .friction = feel.friction,
            .damping = felt_.part * float(feel.damping)};
}

}  // namespace palpate
