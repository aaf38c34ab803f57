#include "palpate/run/probe.h"

#include "palpate/base/error.h"
#include "palpate/touch/drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double rate = 1000;   // Hz
constexpr float beyond = 0.1f;  // m, the radius of the patch of moving surfaces: more than a hand moves in a
                                // frame

}  // namespace

std::vector<Feel> feels_of(const Scene& scene) {
    std::vector<Feel> feels;
    for (const BodyRecipe& recipe : scene.bodies) feels.push_back(recipe.feel);
    for (const BodyRecipe& recipe : scene.surfaces) feels.push_back(recipe.feel);
    return feels;
}

void check_devices(const Scene& scene) {
    for (const ToolRecipe& tool : scene.tools) {
        const bool known = std::ranges::any_of(drivers(), [&](const Driver& one) {
            return one.name == tool.device && one.needs == DeviceNeeds::path;
        });
        if (!known)
            throw Error(fmt::format("tool {}: no device \"{}\" that follows a path", tool.name, tool.device),
                        tool.lines.where("device", scene.file),
                        "there are " + names_of_drivers(DeviceNeeds::path));
    }
}

Probe::Probe(const ToolRecipe& recipe, const Scene& scene)
    : recipe_(recipe), file_(scene.file), feels_(feels_of(scene)) {}

void Probe::set(std::vector<Feel> feels) {
    feels_ = std::move(feels);
    if (hand_) hand_->touch().set({.radius = recipe_.radius, .feels = feels_});
}

void Probe::begin(double time, const std::vector<Skin>& skins) {
    const vec3 origin = recipe_.from ? brought_to_touch(recipe_, file_, skins) : vec3(0);
    Path path = recipe_.path;
    for (Waypoint& point : path) {
        point.time -= time + 1 / rate;  // the device counts from its first read
        point.position += origin;
    }
    const vec3 from = origin + position(recipe_.path, time);
    start_ = time;
    hand_ = std::make_unique<FeltHand>(driver(recipe_.device).make({.path = std::move(path)}),
                                       TouchSettings{.radius = recipe_.radius, .feels = feels_}, from);
}

void Probe::expect_jump() {
    if (hand_) hand_->expect_jump();
}

void Probe::advance(double time, double seconds, const std::vector<Skin>& skins, bool moving) {
    const bool first = !hand_;
    if (first) begin(time, skins);
    // Everything that stands still is set once.
    if (moving)
        hand_->feel(skins, time, beyond);
    else if (first)
        hand_->feel(skins, time);
    double sum = 0;
    long count = 0;
    for (; start_ + double(ticks_ + 1) / rate <= time + seconds + 1e-9; ++count) {
        hand_->tick(start_ + double(++ticks_) / rate);
        sum += glm::length(hand_->felt().force);
    }
    if (count > 0) force_ = sum / double(count);
}

std::vector<Dent> Probe::dents(int surface, double time) const {
    if (!hand_) return {};
    Felt felt = hand_->felt();
    if (!is_there(time)) felt.count = felt.lasting;
    return felt.dents_of(surface);
}

}  // namespace palpate
