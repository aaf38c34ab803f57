// The viewer's hands: the pointer's, those that were left, and a device's.
#include "app/viewer/viewer.h"
#include "palpate/base/clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr float beyond = 0.04f;  // m around a hand that it knows: it goes no farther before the next picture
constexpr float away = 0.02f;    // m: so far before a surface a hand waits that does not dent it
constexpr float dent_depth = 0.6f;  // in radii of its tip
constexpr float jump = 0.04f;       // m: no person moves a hand so far from one picture to the next

// Side by side the same point is in both halves.
vec2 in_view(vec2 pixel, ivec2 view, ivec2 whole) {
    if (view.x < whole.x && pixel.x >= float(view.x)) pixel.x -= float(view.x);
    return pixel;
}

}  // namespace

void Viewer::look_with_mouse() {
    if (!mouse_) return;
    looked_ = view_size();
    pointed_.reset();
    mouse_->look(camera(), looked_);
}

void Viewer::press(Button button, bool shift, bool alt) {
    if (!experiment_ || drag_ != Drag::none) return;
    drag_button_ = button;
    moved_ = now();
    if (button == Button::middle || (button == Button::right && shift)) {
        drag_ = Drag::pan;
    } else if (button == Button::right || alt) {
        drag_ = Drag::turn;
    } else {
        attempt([&] { reach_in(); });
    }
}

void Viewer::reach_in() {
    const Ray ray = ray_through(camera(), in_view(pointer_, view_size(), size_), view_size());
    const auto hit = pick(ray, experiment_->play().skins());
    if (!hit) {
        drag_ = Drag::turn;  // beside everything
        return;
    }
    touched_ = true;
    selected_.assign({hit->place - 4 * options.tip, hit->place + 4 * options.tip});
    if (options.mode == Mode::dent) return start_denting();
    if (hit->surface >= experiment_->models().models.size())
        return say("nothing moves this surface; it can be dented");
    if (replay_) return say("a recording is replayed; press R to begin anew");
    if (options.mode == Mode::pin) return pin_at(*hit);
    Hold hold = options.mode == Mode::pull ? Hold::pulling(*experiment_, *hit)
                                           : Hold::pressing(*experiment_, *hit, ray, options.tip);
    if (!room_for(hold))
        return say("no more hands fit on this body; press K to let go of those you left", true);
    holds_.push_back(hold);
    active_ = holds_.size() - 1;
    drag_ = Drag::hold;
    depth_ = glm::dot(hold.target() - camera().eye, forward_of(camera()));
}

// Beside all others.
bool Viewer::room_for(const Hold& hold) const {
    std::vector<Hold> all = holds();
    all.push_back(hold);
    Hands hands;
    for (Hold& one : all) one.add_to(hands);
    return experiment_->takes(hands);
}

void Viewer::pin_at(const Hit& hit) {
    const Body& body = experiment_->models().models[hit.surface].body;
    const auto positions = experiment_->play().nodes(hit.surface).positions;
    int nearest = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (glm::distance(positions[i], hit.place) <
            glm::distance(positions[std::size_t(nearest)], hit.place))
            nearest = int(i);
    const bool fast = !experiment_->is_pinned(hit.surface, nearest);
    std::vector<int> nodes;
    const float reach = std::max(options.tip, 0.5f * body.spacing);
    for (std::size_t i = 0; i < body.count(); ++i)
        if (int(i) == nearest || glm::distance(positions[i], positions[std::size_t(nearest)]) <= reach)
            nodes.push_back(int(i));
    alter([&] { experiment_->pin(hit.surface, nodes, fast); },
          fmt::format("{} {} node{}", fast ? "pinned" : "let go of", nodes.size(),
                      nodes.size() > 1 ? "s" : ""));
}

void Viewer::release(Button button) {
    if (button != drag_button_) return;
    moved_ = now();
    if (drag_ == Drag::hold && active_) {
        holds_.erase(holds_.begin() + std::ptrdiff_t(*active_));
        active_.reset();
    }
    if (denting_) {
        denting_ = false;
        push_ = 0;
        follow_pointer();
    }
    drag_ = Drag::none;
}

void Viewer::move_pointer(vec2 pixel) {
    pixel.x -= float(left_);
    const vec2 by = pixel - pointer_;
    pointer_ = pixel;
    if (!experiment_) return;
    if (drag_ == Drag::turn || drag_ == Drag::pan) {
        drag_ == Drag::turn ? orbit_.turn(by, size_.y) : orbit_.pan(by, size_.y);
        moved_ = now();
        look_with_mouse();
        return;
    }
    if (!active_) return;  // what feels follows once a picture
    moved_ = now();
    follow_pointer();
}

// What it holds goes along, as deep in the picture as it is.
vec3 Viewer::follow_pointer() {
    const vec2 pixel = in_view(pointer_, view_size(), size_);
    const Ray ray = ray_through(camera(), pixel, view_size());
    const vec3 forward = forward_of(camera());
    if (active_) {
        const float start = glm::dot(ray.from - camera().eye, forward);
        holds_[*active_].go_to(ray.at((depth_ - start) / glm::dot(ray.along, forward)));
    }
    if (!mouse_) return ray.at(depth_);
    // A hand that dents follows the surface under the pointer; where there is none it stays as deep.
    const float slant = glm::dot(ray.along, forward);
    const float middle = glm::distance(camera().look_at, camera().eye), notch = MouseSettings{}.notch;
    auto event = [&](float depth, bool pressed) {
        return PointerEvent{now(), pixel, pressed ? 1u : 0u, (depth - middle) / notch};
    };
    const auto hit = pick(ray, experiment_->play().skins());
    const float before = hit ? hit->way * slant - away : mouse_depth_;  // the surface
    const float goal = denting_ && hit ? before + away + push_ : before;
    const vec3 place = ray.at(goal / slant);
    // Where it only hovers, or goes farther than a hand does, it is there at once: before the surface, and
    // not through what lies between.
    const bool hovers = !denting_ && pointed_ != pixel;
    const bool jumps = denting_ && glm::distance(place, mouse_place_) > std::max(jump, 4 * options.tip);
    if (hovers || jumps) mouse_->place(event(before, false));
    if (!hovers) mouse_->point(event(goal, denting_));
    pointed_ = pixel;
    mouse_depth_ = goal;
    mouse_place_ = place;
    return place;
}

void Viewer::wheel(float notches) {
    if (!experiment_) return;
    moved_ = now();
    if (active_) {
        depth_ += notches * 0.25f * options.tip;
        follow_pointer();
    } else if (denting_) {
        push_ = std::clamp(push_ + notches * 0.15f * options.tip, 0.0f, 4 * options.tip);
        follow_pointer();
    } else {
        orbit_.zoom(notches);
        look_with_mouse();
    }
}

void Viewer::keep() {
    if (denting_) return;
    moved_ = now();
    if (active_) {
        active_.reset();
        drag_ = Drag::none;
        say("it stays there; K again lets go");
    } else {
        let_go();
    }
}

void Viewer::frame_selection() {
    if (!experiment_) return;
    Bounds box;
    for (vec3 p : selected_) box.include(p);
    orbit_.frame(box.empty() ? bounds_of(experiment_->play().skins()) : box);
    look_with_mouse();
    selected_.clear();
    moved_ = now();
}

void Viewer::reset_camera() {
    orbit_.reset();
    look_with_mouse();
    moved_ = now();
}

// ---- the hand that feels ----

void Viewer::make_feeling_hand() {
    // Whatever follows no pointer needs a file, and waits for it to be named.
    const DeviceNeeds needs = driver(options.device).needs;
    const bool by_mouse = needs == DeviceNeeds::pointer && options.mode == Mode::dent;
    const bool by_device =
        needs != DeviceNeeds::pointer && options.mode != Mode::pin && !options.device_file.empty();
    const bool wanted = experiment_ && (by_mouse || by_device);
    HandSettings of;
    if (wanted)
        of = {options.device, options.device_file, options.tip, feels_of(experiment_->scene()),
              experiment_->shapes()};
    if (!wanted && !feeling_) return;
    if (wanted && feeling_ && feeling_of_ == of) return;
    const bool stays = wanted && feeling_ && feeling_of_.device == of.device && feeling_of_.file == of.file &&
                       feeling_of_.feels.size() == of.feels.size();
    if (stays) {
        feeling_->touch().set({.radius = of.tip, .feels = of.feels});
        if (feeling_of_.shapes != of.shapes) feeling_->begin_anew();
        feeling_of_ = std::move(of);
        return;
    }
    drop_feeling_hand();
    denting_ = false;  // a new one begins before the surface, not in it
    if (!wanted) return;
    attempt([&] {
        DeviceSettings settings{.path = {}, .mouse = {.camera = camera(), .size = view_size()}, .log = {}};
        if (needs == DeviceNeeds::log) settings.log = options.device_file;
        if (needs == DeviceNeeds::path) settings.path = read_path(options.device_file);
        auto device = driver(options.device).make(settings);
        vec3 start = settings.path.empty() ? camera().look_at : settings.path.front().position;
        mouse_ = dynamic_cast<Mouse*>(device.get());
        if (mouse_) {
            mouse_depth_ = glm::distance(camera().look_at, camera().eye);
            pointed_.reset();
            start = follow_pointer();  // so that it begins there and does not come from elsewhere
        }
        auto hand = std::make_unique<FeltHand>(
            std::move(device), TouchSettings{.radius = of.tip, .feels = of.feels}, start, warmth_);
        hand->feel(experiment_->play().skins(), now(), beyond);
        hand->go_live();
        feeling_ = std::move(hand);
    });
    if (!feeling_) {  // and it is said why
        mouse_ = nullptr;
        options.device_file.clear();
        if (by_mouse) options.mode = Mode::pull;
    }
    feeling_of_ = std::move(of);
    looked_ = view_size();
}

// Its motors cool down while there is none.
void Viewer::drop_feeling_hand() {
    if (feeling_) warmth_ = feeling_->touch().felt().warmth;
    feeling_.reset();
    mouse_ = nullptr;
    strokes_.clear();
}

// The latest that is still there, if no change of the scene came after it.
const Viewer::Stroke* Viewer::last_dent() const {
    const int last = feeling_ ? feeling_->felt().last_stroke : 0;
    for (auto stroke = strokes_.rbegin(); stroke != strokes_.rend(); ++stroke)
        if (stroke->number <= last)
            return stroke->changes >= experiment_->changes_made() ? &*stroke : nullptr;
    return nullptr;
}

// A device that is no mouse does what is chosen too: it presses wherever it is, or takes hold of what it
// touches until its first button is pressed.
void Viewer::follow_device() {
    const bool acts = feeling_ && driver(options.device).needs != DeviceNeeds::pointer &&
                      !experiment_->models().models.empty() &&
                      (options.mode == Mode::pull || options.mode == Mode::press);
    const Felt felt = acts ? feeling_->felt() : Felt{};
    const vec3 place(felt.pose.place);
    const bool presses = options.mode == Mode::press;
    const bool lets_go = !acts || (!presses && felt.buttons & 1);
    if (device_hold_ && (lets_go || device_hold_->presses() != presses || !device_hold_->fits(*experiment_)))
        device_hold_.reset();
    if (lets_go || felt.time == 0) return;
    std::optional<Hold> begun;
    if (!device_hold_ && presses) {
        begun = Hold::tip(*experiment_, 0, place, options.tip);
    } else if (!device_hold_ && felt.count > felt.lasting) {
        const auto touched = std::size_t(felt.surfaces[std::size_t(felt.lasting)]);
        if (touched < experiment_->models().models.size())
            begun = Hold::pulling(*experiment_, {.surface = touched, .place = place});
    }
    if (begun && room_for(*begun)) device_hold_ = begun;
    if (device_hold_) device_hold_->go_to(place);
}

std::vector<Hold> Viewer::holds() const {
    std::vector<Hold> all = holds_;
    if (device_hold_) all.push_back(*device_hold_);
    return all;
}

void Viewer::start_denting() {
    if (!mouse_) return;
    follow_pointer();  // it begins before the surface,
    denting_ = true;   // and goes in
    push_ = dent_depth * options.tip;
    drag_ = Drag::hold;
    strokes_.push_back({feeling_->touch().begin_stroke(), experiment_->changes_made()});
    follow_pointer();
}

void Viewer::feel() {
    make_feeling_hand();
    if (!feeling_) return;
    if (looked_ != view_size()) look_with_mouse();
    feeling_->feel(experiment_->play().skins(), now(), beyond);
    if (mouse_) follow_pointer();
}

}  // namespace palpate
