#include "palpate/viewer/viewer_touch.h"

#include "palpate/base/clock.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr float beyond = 0.04f;     // m, the radius of the patch around the hand, which moves less until the
                                    // next picture
constexpr float away = 0.02f;       // m, how far in front of a surface the hand hovers
constexpr float dent_depth = 0.6f;  // in radii of its tip
constexpr float jump = 0.04f;       // m: more than a person moves a hand between two pictures

float middle_of(const Camera& camera) { return glm::distance(camera.look_at, camera.eye); }

}  // namespace

// ---- making it ----

void ViewerTouch::advance(const Experiment& experiment, Options& options, const Sight& sight) {
    become(experiment, options, sight);
    if (!hand_) return;
    if (looked_ != sight.size) look(sight);
    hand_->feel(experiment.play().skins(), now(), beyond);
    if (mouse_) follow_pointer(experiment, options.tip, sight);
}

void ViewerTouch::become(const Experiment& experiment, Options& options, const Sight& sight) {
    // A device that does not follow the pointer needs a file, so wait until it is named.
    const bool by_mouse = driver(options.device).needs == DeviceNeeds::pointer;
    const bool wanted =
        by_mouse ? options.mode == Mode::dent : options.mode != Mode::pin && !options.device_file.empty();
    if (!wanted) return drop();
    Kind kind{options.device, options.device_file, options.tip, feels_of(experiment.scene()),
              experiment.shapes()};
    if (hand_ && kind_ == kind) return;
    std::swap(kind_, kind);
    if (hand_ && kind.device == kind_.device && kind.file == kind_.file &&
        kind.feels.size() == kind_.feels.size()) {
        hand_->touch().set({.radius = kind_.tip, .feels = kind_.feels});
        if (kind.shapes != kind_.shapes) hand_->begin_anew();
        return;
    }
    drop();  // a new one begins in front of the surface, not in it
    if (message_.attempt([&] { make(experiment, sight); })) return;
    mouse_ = nullptr;
    options.device_file.clear();
    if (by_mouse) options.mode = Mode::pull;
}

void ViewerTouch::make(const Experiment& experiment, const Sight& sight) {
    const Driver& driver = palpate::driver(kind_.device);
    DeviceSettings settings{.path = {}, .mouse = {.camera = sight.camera, .size = sight.size}, .log = {}};
    if (driver.needs == DeviceNeeds::log) settings.log = kind_.file;
    if (driver.needs == DeviceNeeds::path) settings.path = read_path(kind_.file);
    auto device = driver.make(settings);
    vec3 start = settings.path.empty() ? sight.camera.look_at : settings.path.front().position;
    mouse_ = dynamic_cast<Mouse*>(device.get());
    looked_ = sight.size;
    if (mouse_) {
        depth_ = middle_of(sight.camera);
        pointed_.reset();
        // So that it begins there instead of moving there.
        start = follow_pointer(experiment, kind_.tip, sight);
    }
    auto hand = std::make_unique<FeltHand>(
        std::move(device), TouchSettings{.radius = kind_.tip, .feels = kind_.feels}, start, warmth_);
    hand->feel(experiment.play().skins(), now(), beyond);
    hand->go_live();
    hand_ = std::move(hand);
}

void ViewerTouch::drop() {
    if (hand_) warmth_ = hand_->touch().felt().warmth;
    hand_.reset();
    mouse_ = nullptr;
    strokes_.clear();
    denting_ = false;
}

void ViewerTouch::look(const Sight& sight) {
    if (!mouse_) return;
    looked_ = sight.size;
    pointed_.reset();
    mouse_->look(sight.camera, sight.size);
}

void ViewerTouch::expect_jump() {
    if (hand_) hand_->expect_jump();
}

void ViewerTouch::begin_anew() {
    strokes_.clear();
    if (hand_) hand_->begin_anew();
}

// ---- the pointer's ----

// Follows the surface under the pointer, and returns its place; without a surface it keeps its depth.
vec3 ViewerTouch::follow_pointer(const Experiment& experiment, float tip, const Sight& sight) {
    auto event = [&](float depth, bool pressed) {
        return PointerEvent{now(), sight.pixel, pressed ? 1u : 0u,
                            (depth - middle_of(sight.camera)) / MouseSettings{}.notch};
    };
    const auto hit = pick(sight.ray(), experiment.play().skins());
    const float before = hit ? sight.depth_of(hit->place) - away : depth_;  // the surface
    const float goal = denting_ && hit ? before + away + push_ : before;
    const vec3 place = sight.at_depth(goal);
    // If it only hovers, or moves farther than a hand can, it jumps there, in front of the surface, instead
    // of moving through what lies between.
    const bool hovers = !denting_ && pointed_ != sight.pixel;
    const bool jumps = denting_ && glm::distance(place, place_) > std::max(jump, 4 * tip);
    if (hovers || jumps) mouse_->place(event(before, false));
    if (!hovers) mouse_->point(event(goal, denting_));
    pointed_ = sight.pixel;
    depth_ = goal;
    place_ = place;
    return place;
}

bool ViewerTouch::begin_dent(const Experiment& experiment, float tip, const Sight& sight) {
    if (!mouse_) return false;
    follow_pointer(experiment, tip, sight);  // it begins in front of the surface,
    denting_ = true;                         // and goes in
    push_ = dent_depth * tip;
    strokes_.push_back({hand_->touch().begin_stroke(), experiment.changes_made()});
    follow_pointer(experiment, tip, sight);
    return true;
}

void ViewerTouch::deepen(const Experiment& experiment, float notches, float tip, const Sight& sight) {
    push_ = std::clamp(push_ + notches * 0.15f * tip, 0.0f, 4 * tip);
    follow_pointer(experiment, tip, sight);
}

void ViewerTouch::end_dent(const Experiment& experiment, float tip, const Sight& sight) {
    if (!denting_) return;
    denting_ = false;
    push_ = 0;
    follow_pointer(experiment, tip, sight);
}

const ViewerTouch::Stroke* ViewerTouch::last_dent(const Experiment* experiment) const {
    const int last = hand_ ? hand_->felt().last_stroke : 0;
    for (auto stroke = strokes_.rbegin(); stroke != strokes_.rend(); ++stroke)
        if (stroke->number <= last) return stroke->changes >= experiment->changes_made() ? &*stroke : nullptr;
    return nullptr;
}

void ViewerTouch::undo(const Experiment* experiment) {
    const Stroke* stroke = last_dent(experiment);
    if (!stroke) return;
    hand_->touch().forget(stroke->number);
    strokes_.resize(std::size_t(stroke - strokes_.data()));
}

// ---- for drawing ----

std::optional<Felt> ViewerTouch::device(const Experiment& experiment, const Options& options) const {
    const bool acts = hand_ && driver(options.device).needs != DeviceNeeds::pointer &&
                      !experiment.models().models.empty() &&
                      (options.mode == Mode::pull || options.mode == Mode::press);
    return acts ? std::optional(hand_->felt()) : std::nullopt;
}

std::optional<Arrow> ViewerTouch::arrow() const {
    if (!hand_ || !(glm::length(hand_->felt().force) > 0)) return std::nullopt;
    return Arrow{hand_->felt().proxy, hand_->felt().force};
}

void ViewerTouch::add_to(Traces& traces, std::size_t surfaces, float tip) const {
    if (!hand_) return;
    const Felt& felt = hand_->felt();
    const vec3 hand(felt.pose.place);
    // A small ball, or it would hide the dent; the controls draw a ring of the tip's size.
    traces.balls.push_back({felt.proxy, 0.25f * tip, proxy_colour});
    if (glm::distance(hand, felt.proxy) > 0.05f * tip) {
        traces.balls.push_back({hand, 0.2f * tip, hand_colour});
        traces.add_line(felt.proxy, hand);
    }
    for (std::size_t s = 0; s < surfaces; ++s) traces.dents.push_back(felt.dents_of(int(s)));
}

}  // namespace palpate
