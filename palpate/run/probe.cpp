#include "palpate/run/probe.h"

#include "palpate/base/error.h"
#include "palpate/touch/drivers.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double rate = 1000;   // Hz
constexpr float beyond = 0.1f;  // m, the radius of the patch of moving surfaces: more than a hand moves in a
                                // frame

constexpr float in_a_slice = 0.02f;  // m, likewise beyond the tip, for slices of a millisecond or so

int ticks_in(double seconds) { return std::max(1, int(std::ceil(seconds * rate - 1e-6))); }

// Pa, of an elastic half-space: Young's modulus over 1 - Poisson's ratio²; 0 where none is known.
double modulus_of_half_space(const Body& body) {
    if (const TissueCells* cells = tissue_of(body))
        return double(cells->youngs_modulus) / (1 - double(cells->poisson) * double(cells->poisson));
    const GridSprings* grid = body.cells.empty() ? nullptr : body.grid();
    if (!grid) return 0;
    float stiffest = 0;
    for (const Link& link : grid->links) stiffest = std::max(stiffest, link.stiffness);
    return double(stiffest) / (0.4 * double(body.spacing)) / (1 - 1 / 16.0);  // as lattice.h says
}

// m/N: how far a body yields to a round tip within some seconds. A half-space yields so far to a rigid disc
// (Sneddon 1965), and what lies under the tip has to be accelerated first.
double compliance(const Body& body, double radius, double seconds) {
    double heaviest = 0;  // kg, of a node
    for (float inverse : body.inverse_mass)
        if (inverse > 0) heaviest = std::max(heaviest, 1 / double(inverse));
    const double density = heaviest / std::pow(double(body.spacing), 3),
                 moved = 2.0 / 3 * glm::pi<double>() * std::pow(radius, 3) * density;
    return 1 / (2 * moved / (seconds * seconds) + 2 * radius * modulus_of_half_space(body));
}

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
    hand_ = std::make_unique<FeltHand>(driver(recipe_.device).make({.path = std::move(path)}),
                                       TouchSettings{.radius = recipe_.radius, .feels = feels_}, from);
    if (presses()) untouched_ = skins;
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
    tick(time, seconds);
}

Press Probe::press(double time, double seconds, dvec3 reaction, const std::vector<Skin>& skins,
                   std::span<const Model> bodies) {
    if (!hand_) begin(time, skins);
    Simulated simulated{.surfaces = bodies.size()};
    if (slice_ > 0) simulated.load = reaction / slice_;
    slice_ = seconds;
    for (const Model& model : bodies)
        simulated.compliance =
            std::max(simulated.compliance, compliance(model.body, recipe_.radius, seconds));
    const bool ticked = hand_->felt().time > 0;
    const vec3 from = ticked ? vec3(hand_->felt().pose.place) : hand_->start();
    hand_->feel(skins, time, recipe_.radius + in_a_slice, simulated);
    tick(time, seconds);
    const Felt& felt = hand_->felt();
    double stiffness = 0;
    for (std::size_t b = 0; ticked && b < bodies.size(); ++b)
        stiffness = std::max(stiffness, double(felt.gain) * feels_[b].stiffness);
    return {from, (vec3(felt.pose.place) - from) / float(seconds), recipe_.radius, float(stiffness)};
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
