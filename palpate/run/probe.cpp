#include "palpate/run/probe.h"

#include "palpate/base/error.h"
#include "palpate/run/play.h"
#include "palpate/touch/drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double rate = 1000;   // Hz
constexpr float beyond = 0.1f;  // m, the radius of the patch of moving surfaces: more than a hand moves in a
                                // frame

constexpr float in_a_slice = 0.02f;  // m, likewise beyond the tip, for slices of a millisecond or so

int ticks_in(double seconds) { return std::max(1, int(std::ceil(seconds * rate - 1e-6))); }

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
    near_.forget();
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
    hand_ = std::make_unique<FeltHand>(driver(recipe_.device).make({.path = std::move(path)}),
                                       TouchSettings{.radius = recipe_.radius, .feels = feels_}, from);
    if (!presses()) return;
    untouched_ = skins;
    for (Skin& skin : untouched_) skin.triangles = nullptr;  // places and normals will do
}

void Probe::expect_jump() {
    near_.forget();
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
    tick(time, seconds);
}

Press Probe::press(double time, double seconds, std::optional<dvec3> reaction, const Play& play,
                   const Models& models) {
    if (!hand_) begin(time, play.skins());
    if (reaction && slice_ > 0) load_ = *reaction / slice_;
    slice_ = seconds;
    const float reach = recipe_.radius + in_a_slice;
    const std::size_t bodies = models.models.size();
    const std::vector<Skin>& skins = near_.at(play, models, hand_->place(), reach);
    if (near_.chose()) hand_->remember(near_.before());
    hand_->feel(skins, time, reach, {.surfaces = bodies, .load = load_});
    tick(time, seconds);
    return hand_->press(seconds, bodies);
}

void Probe::tick(double time, double seconds) {
    const int count = ticks_in(seconds);
    for (int i = 1; i <= count; ++i) {
        hand_->tick(time + seconds * i / count);
        forces_ += glm::length(hand_->felt().force);
    }
    ticks_ += count;
}

double Probe::take_force() {
    const double mean = ticks_ > 0 ? forces_ / double(ticks_) : 0;
    forces_ = 0;
    ticks_ = 0;
    return mean;
}

double Probe::depth(const std::vector<Skin>& skins) const {
    return presses() ? indentation(untouched_, skins, centre(), recipe_.radius) : double(hand_->felt().depth);
}

std::vector<Dent> Probe::dents(int surface, double time) const {
    if (!hand_) return {};
    Felt felt = hand_->felt();
    if (!is_there(time)) felt.count = felt.lasting;
    return felt.dents_of(surface);
}

}  // namespace palpate
