#include "palpate/run/probe.h"

#include "palpate/base/error.h"
#include "palpate/touch/drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double rate = 1000;   // Hz
constexpr float beyond = 0.1f;  // m around the hand that it knows of what moves: more than it goes in a frame

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
    if (touch_) touch_->set({.radius = recipe_.radius, .feels = feels_});
}

void Probe::begin(double time, const std::vector<Skin>& skins) {
    if (recipe_.from) origin_ = brought_to_touch(recipe_, file_, skins);
    Path path = recipe_.path;
    for (Waypoint& point : path) {
        point.time -= time + 1 / rate;  // the device counts from its first read
        point.position += origin_;
    }
    start_ = time;
    touch_ = std::make_unique<Touch>(driver(recipe_.device).make({.path = std::move(path)}),
                                     TouchSettings{.radius = recipe_.radius, .feels = feels_});
}

void Probe::advance(double time, double seconds, const std::vector<Skin>& skins,
                    const std::vector<std::vector<vec3>>& velocities, bool moving) {
    if (!touch_) begin(time, skins);
    if (moving || !knows_surfaces_) touch_->feel(patch(time, skins, velocities));
    knows_surfaces_ = true;
    double sum = 0;
    long count = 0;
    for (; start_ + double(ticks_ + 1) / rate <= time + seconds + 1e-9; ++count) {
        touch_->tick(start_ + double(++ticks_) / rate);
        felt_ = touch_->felt();
        sum += glm::length(felt_.force);
    }
    if (count > 0) force_ = sum / double(count);
    depth_ = felt_.depth;
}

// All of what stands still, once and for all; of what moves the neighbourhood.
Patch Probe::patch(double time, const std::vector<Skin>& skins,
                   const std::vector<std::vector<vec3>>& velocities) const {
    std::vector<Touchable> surfaces;
    bool anything_moves = false;
    for (std::size_t s = 0; s < skins.size(); ++s) {
        surfaces.push_back({skins[s].positions, *skins[s].triangles, velocities[s], skins[s].is_sheet});
        anything_moves |= !velocities[s].empty();
    }
    if (!anything_moves) return Patch(surfaces);
    const vec3 hand = ticks_ > 0 ? felt_.proxy : origin_ + position(recipe_.path, time);
    return Patch(surfaces, hand, beyond, time);
}

std::vector<Dent> Probe::dents(int surface, double time) const {
    std::vector<Dent> list;
    const int count = is_there(time) ? felt_.count : felt_.lasting;
    for (int i = 0; i < count; ++i)
        if (felt_.surfaces[std::size_t(i)] == surface) list.push_back(felt_.dents[std::size_t(i)]);
    return list;
}

}  // namespace palpate
