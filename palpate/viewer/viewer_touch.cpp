#include "palpate/viewer/viewer_touch.h"

#include "palpate/base/clock.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr float beyond = 0.04f;     // m, the radius of the patch around the hand, which moves less until the
                                    // next picture
constexpr float away = 0.02f;       // m, how far in front of a surface the hand hovers
constexpr float usual_push = 0.6f;  // in radii of its tip
constexpr float jump = 0.04f;       // m: more than a person moves a hand between two pictures

// Of a hand without motors: nothing needs to begin gently.
constexpr SafetySettings without_motors{.small_force = 1e6, .calm = 0.01, .ramp = 0.01};

// Bodies are felt as they answer, so without LiveTouch not at all.
void feel_what_stands(FeltHand& hand, const Experiment& experiment) {
    hand.feel(experiment.play().skins(), now(), beyond, {.surfaces = experiment.models().models.size()});
}

float middle_of(const Camera& camera) { return glm::distance(camera.look_at, camera.eye); }

}  // namespace

// ---- making it ----

void ViewerTouch::advance(const Experiment& experiment, Options& options, const Sight& sight) {
    become(experiment, options, sight);
    if (!hand_) return;
    if (looked_ != sight.size) look(sight);
    if (!live_) feel_what_stands(*hand_, experiment);
    if (mouse_) follow_pointer(experiment, options.tip, sight);
}

void ViewerTouch::become(const Experiment& experiment, Options& options, const Sight& sight) {
    // A device that does not follow the pointer needs a file, so wait until it is named.
    const bool by_mouse = driver(options.device).needs == DeviceNeeds::pointer;
    if (options.mode != Mode::hand || (!by_mouse && options.device_file.empty())) return drop();
    Kind kind{options.device, options.device_file, options.tip, feels_of(experiment.scene()),
              experiment.shapes()};
    if (hand_ && kind_ == kind) return;
    std::swap(kind_, kind);
    if (hand_ && kind.device == kind_.device && kind.file == kind_.file &&
        kind.feels.size() == kind_.feels.size()) {
        TouchSettings settings = hand_->touch().settings();
        settings.radius = kind_.tip;
        settings.feels = kind_.feels;
        hand_->touch().set(settings);
        if (kind.shapes != kind_.shapes) hand_->begin_anew();
        return;
    }
    drop();  // a new one begins in front of the surface, not in it
    if (message_.attempt([&] { make(experiment, sight); })) return;
    mouse_ = nullptr;
    options.device_file.clear();
    if (by_mouse) options.mode = Mode::pin;
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
    const TouchSettings of_touch{
        .radius = kind_.tip, .feels = kind_.feels, .safety = mouse_ ? without_motors : SafetySettings{}};
    auto hand = std::make_unique<FeltHand>(std::move(device), of_touch, start, warmth_);
    feel_what_stands(*hand, experiment);
    hand->go_live();
    hand_ = std::move(hand);
}

void ViewerTouch::drop() {
    if (hand_) warmth_ = hand_->touch().felt().warmth;
    live_.reset();
    hand_.reset();
    mouse_ = nullptr;
    strokes_.clear();
    pressing_ = false;
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

namespace {

// The mean depth of what lies around the tip and faces the eye; that of `hit` where nothing does.
float depth_around(const Skin& skin, const Hit& hit, float tip, const Sight& sight) {
    const vec3 forward = forward_of(sight.camera);
    float sum = 0, count = 0;
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        const vec3 off = skin.positions[i] - hit.place;
        const float along = glm::dot(off, forward), aside = glm::length(off - along * forward);
        if (aside < 1.5f * tip || aside > 3 * tip || std::abs(along) > 3 * tip) continue;
        if (glm::dot(skin.normals[i], forward) > 0) continue;
        sum += along;
        ++count;
    }
    return sight.depth_of(hit.place) + (count > 0 ? sum / count : 0);
}

}  // namespace

// Follows the surface under the pointer, and returns its place; without a surface it keeps its depth.
vec3 ViewerTouch::follow_pointer(const Experiment& experiment, float tip, const Sight& sight) {
    auto event = [&](float depth, bool pressed) {
        return PointerEvent{now(), sight.pixel, pressed ? 1u : 0u,
                            (depth - middle_of(sight.camera)) / MouseSettings{}.notch};
    };
    const std::vector<Skin>& skins = experiment.play().skins();
    const auto hit = pick(sight.ray(), skins);
    at_surface_ = hit.has_value();
    const float before = hit ? sight.depth_of(hit->place) - away : depth_;  // the surface
    const float goal =
        pressing_ && hit ? depth_around(skins[hit->surface], *hit, tip, sight) - rise_ - tip + push_ : before;
    const vec3 place = sight.at_depth(goal);
    // What it presses down must not lead it deeper and deeper, so its depth is that below the surface around
    // it. If it only hovers, or moves farther than a hand can, it jumps there, in front of the surface,
    // instead of moving through what lies between.
    const bool hovers = !pressing_ && pointed_ != sight.pixel;
    const bool jumps = pressing_ && glm::distance(place, place_) > std::max(jump, 4 * tip);
    if (hovers || jumps) mouse_->place(event(before, false));
    if (!hovers) mouse_->point(event(goal, pressing_));
    pointed_ = sight.pixel;
    depth_ = goal;
    place_ = place;
    return place;
}

bool ViewerTouch::begin_press(const Experiment& experiment, float tip, const Sight& sight) {
    if (!mouse_) return false;
    follow_pointer(experiment, tip, sight);  // it begins in front of the surface,
    pressing_ = true;                        // and goes in
    push_ = usual_push * tip;
    const auto hit = pick(sight.ray(), experiment.play().skins());
    rise_ = hit ? depth_around(experiment.play().skins()[hit->surface], *hit, tip, sight) -
                      sight.depth_of(hit->place)
                : 0;
    strokes_.push_back({hand_->touch().begin_stroke(), experiment.changes_made()});
    follow_pointer(experiment, tip, sight);
    return true;
}

void ViewerTouch::deepen(const Experiment& experiment, float notches, float tip, const Sight& sight) {
    push_ = std::clamp(push_ + notches * 0.15f * tip, 0.0f, 4 * tip);
    follow_pointer(experiment, tip, sight);
}

void ViewerTouch::end_press(const Experiment& experiment, float tip, const Sight& sight) {
    if (!pressing_) return;
    pressing_ = false;
    push_ = 0;
    follow_pointer(experiment, tip, sight);
}

// ---- its bodies ----

LiveTouch* ViewerTouch::live(Session& session, bool may) {
    const bool is_wanted = may && hand_ && (!mouse_ || pressing_) && session.experiment() &&
                           !session.experiment()->models().models.empty();
    const bool is_right = lives_ == session.experiment() && lives_beside_ == session.beside();
    if (live_ && !(is_wanted && is_right)) {
        live_.reset();
        hand_->expect_jump();
    }
    if (is_wanted && !live_) {
        hand_->expect_jump();
        live_ =
            std::make_unique<LiveTouch>(*session.experiment(), std::vector{hand_.get()}, session.beside());
        lives_ = session.experiment();
        lives_beside_ = session.beside();
    }
    return live_.get();
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

std::optional<Felt> ViewerTouch::device() const {
    return hand_ && !mouse_ ? std::optional(hand_->felt()) : std::nullopt;
}

std::optional<Arrow> ViewerTouch::arrow() const {
    if (!hand_ || !(glm::length(hand_->felt().force) > 0)) return std::nullopt;
    return Arrow{hand_->felt().proxy, hand_->felt().force};
}

void ViewerTouch::add_to(Traces& traces, std::size_t surfaces, float tip) const {
    const Felt& felt = hand_->felt();
    const vec3 hand = hand_->place();
    // A small ball, or it would hide the dent; the controls draw a ring of the tip's size.
    traces.balls.push_back({felt.proxy, 0.25f * tip, proxy_colour});
    if (glm::distance(hand, felt.proxy) > 0.05f * tip) {
        traces.balls.push_back({hand, 0.2f * tip, hand_colour});
        traces.add_line(felt.proxy, hand);
    }
    for (std::size_t s = 0; s < surfaces; ++s) traces.dents.push_back(felt.dents_of(int(s)));
}

}  // namespace palpate
