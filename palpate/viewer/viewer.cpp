#include "palpate/viewer/viewer.h"

#include "palpate/run/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace palpate {

// ---- what is open ----

void Viewer::open_file(const std::filesystem::path& file) noexcept {
    message_.attempt([&] {
        if (file.extension() == ".json")
            replay(read_recording(file));
        else
            open(find_scene(std::filesystem::absolute(file).string()));
    });
}

void Viewer::begin(Prepared prepared) {
    hold_still();
    session_.begin(std::move(prepared));
    feeling_.drop();
    let_go();
    readings_ = {};
    selected_.clear();
    views_.go_home();
    const Scene& scene = experiment()->scene();
    const Bounds box = bounds_of(experiment()->play().skins());
    options.tip = box.empty() ? 0.01f : std::clamp(0.05f * glm::length(box.size()), 0.002f, 0.5f);
    for (const ToolRecipe& tool : scene.tools)
        if (tool.kind != ToolKind::drag) options.tip = tool.radius;
    options.paused = false;
    std::string opened = (replaying() ? "replaying " : "opened ") + experiment()->source().name;
    for (const std::string& note : notes_before(scene, experiment()->models())) opened += "\n" + note;
    message_.say(opened);
}

void Viewer::let_go() {
    holds_.clear();
    drag_ = Drag::none;
}

// ---- changes ----

// Changes the experiment; the one beside it continues from there. Not during a replay.
void Viewer::alter(const std::function<void()>& how, const std::string& said) {
    if (!experiment()) return;
    if (replaying()) return message_.say("a recording is being replayed; press R to start over");
    const bool done = message_.attempt([&] {
        how();
        session_.compare_anew();
        views_.wake();
    });
    if (done && !said.empty()) message_.say(said);
}

void Viewer::change(const std::vector<Change>& changes, bool again) {
    alter([&] { experiment()->change(changes, again); });
}

bool Viewer::can_undo() const {
    return feeling_.can_undo(experiment()) || (experiment() && experiment()->can_undo());
}

void Viewer::undo() {
    if (feeling_.can_undo(experiment())) {
        feeling_.undo(experiment());
        views_.wake();
        return message_.say("the dent is gone");
    }
    if (can_undo()) alter([&] { experiment()->undo(); }, "undone");
}

void Viewer::redo() {
    if (experiment() && experiment()->can_redo()) alter([&] { experiment()->redo(); }, "done again");
}

void Viewer::restart() {
    session_.stop_replaying();
    let_go();
    alter([&] { experiment()->restart(); }, "from the beginning");
    feeling_.begin_anew();
}

void Viewer::return_to_good() {
    if (!experiment() || !experiment()->can_return()) return;
    if (!replaying()) let_go();
    alter([&] { experiment()->return_to_good(); }, "as it was a moment ago");
    feeling_.expect_jump();
}

void Viewer::step_once() {
    options.paused = true;
    if (experiment()) one_frame();
}

// ---- advancing ----

void Viewer::advance(int frames) {
    hold_still();
    if (auto prepared = session_.take_import()) message_.attempt([&] { begin(std::move(*prepared)); });
    if (!experiment()) return;
    holds_.keep_fitting(*experiment());
    if (drag_ == Drag::hold && !is_holding()) drag_ = Drag::none;
    if (session_.compare(options.compared)) views_.wake();
    if (std::exchange(went_on_, false)) frames = 0;
    for (int f = 0; f < frames && !options.paused && (replaying() || experiment()->trouble().empty()); ++f)
        one_frame();
    session_.say_trouble();
    message_.attempt([&] { feeling_.live(session_, may_be_live()); });
    message_.attempt([&] { feeling_.advance(*experiment(), options, sight()); });
    readings_.measure(*experiment(), !options.paused);
    if (feeling()) readings_.feel(feeling()->felt());
}

bool Viewer::may_be_live() const {
    return experiment() && !options.paused && !replaying() && experiment()->trouble().empty();
}

// What else hands do in the next frame.
Interaction Viewer::hands() {
    Interaction hands;
    if (replaying()) return hands;
    holds_.follow(*experiment(), feeling_.device(), options.tip);
    holds_.add_to(hands);
    return hands;
}

void Viewer::hand_over_to(LiveTouch& live) {
    live.set(hands());
    if (const std::optional<Hold>& hold = holds_.of_device())
        live.grasp(0, hold->pulls_at(hold->place()), hold->place());
    else
        live.grasp(0, {});
}

// A film shows every frame of the scene, so it does not go on by itself.
void Viewer::go_on() {
    hold_still();
    LiveTouch* live = nullptr;
    message_.attempt([&] { live = feeling_.live(session_, may_be_live()); });
    if (!live || filming() || !live->may_go_on()) return;
    message_.attempt([&] {
        hand_over_to(*live);
        live->go_on();
        live_ = went_on_ = true;
    });
}

void Viewer::hold_still() {
    if (!std::exchange(live_, false)) return;
    if (!message_.attempt([&] { feeling_.live()->hold_still(); }))
        options.paused = true;  // it would fail again
    views_.wake();
}

void Viewer::one_frame() {
    bool goes_on = false;
    const bool done = message_.attempt([&] {
        if (LiveTouch* live = feeling_.live(session_, !replaying())) {
            hand_over_to(*live);
            live->advance();
            goes_on = true;
        } else {
            goes_on = session_.advance(hands());
        }
    });
    if (!done) session_.stop_replaying();  // it would fail again
    if (!goes_on) options.paused = true;
    views_.wake();
    saving_.frame_done([&] { return image(); });
}

// ---- the pointer ----

void Viewer::press(Button button, bool shift, bool alt) {
    if (!experiment() || drag_ != Drag::none) return;
    drag_button_ = button;
    views_.wake();
    if (button == Button::middle || (button == Button::right && shift))
        drag_ = Drag::pan;
    else if (button == Button::right || alt)
        drag_ = Drag::turn;
    else
        message_.attempt([&] { reach_in(shift); });
}

void Viewer::reach_in(bool pulls) {
    const auto hit = pick(sight().ray(), experiment()->play().skins());
    if (!hit) {
        drag_ = Drag::turn;  // on the background
        return;
    }
    touched_ = true;
    selected_.assign({hit->place - 4 * options.tip, hit->place + 4 * options.tip});
    const bool moves = hit->surface < experiment()->models().models.size();
    if (moves && replaying()) {
        message_.say("a recording is being replayed; press R to start over");
    } else if (options.mode == Mode::hand && !pulls) {
        if (feeling_.begin_press(*experiment(), options.tip, sight()))
            drag_ = Drag::hold;
        else
            message_.say("the device touches and presses; the mouse pulls, with Shift");
    } else if (!moves) {
        message_.say("nothing moves this surface; it can be touched");
    } else if (options.mode == Mode::pin) {
        pin_at(*hit);
    } else {
        holds_.take(Hold::pulling(*experiment(), *hit, options.tip), sight());
        drag_ = Drag::hold;
    }
}

void Viewer::pin_at(const Hit& hit) {
    const Body& body = experiment()->models().models[hit.surface].body;
    const auto positions = experiment()->play().nodes(hit.surface).positions;
    const auto nearest =
        std::ranges::min_element(positions, {}, [&](vec3 p) { return glm::distance(p, hit.place); });
    const bool fast = !experiment()->is_pinned(hit.surface, int(nearest - positions.begin()));
    const float reach = std::max(options.tip, 0.5f * body.spacing);
    std::vector<int> nodes;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (glm::distance(positions[i], *nearest) <= reach) nodes.push_back(int(i));
    alter([&] { experiment()->pin(hit.surface, nodes, fast); },
          fmt::format("{} {} node{}", fast ? "pinned" : "let go of", nodes.size(),
                      nodes.size() > 1 ? "s" : ""));
}

void Viewer::release(Button button) {
    if (button != drag_button_) return;
    views_.wake();
    if (drag_ == Drag::hold) holds_.release();
    if (experiment()) feeling_.end_press(*experiment(), options.tip, sight());
    drag_ = Drag::none;
}

void Viewer::move_pointer(vec2 pixel) {
    pixel.x -= float(left());
    const vec2 by = pixel - pointer_;
    pointer_ = pixel;
    if (!experiment()) return;
    if (drag_ == Drag::turn || drag_ == Drag::pan) {
        drag_ == Drag::turn ? views_.orbit.turn(by, size().y) : views_.orbit.pan(by, size().y);
        turned();
    } else if (holds_.has_own()) {  // a touch follows once a picture
        views_.wake();
        holds_.follow(sight());
    }
}

void Viewer::turned() {
    feeling_.look(sight());
    views_.wake();
}

void Viewer::wheel(float notches) {
    if (!experiment()) return;
    if (holds_.has_own()) {
        holds_.deepen(notches * 0.25f * options.tip);
        holds_.follow(sight());
        views_.wake();
    } else if (feeling_.is_pressing()) {
        feeling_.deepen(*experiment(), notches, options.tip, sight());
        views_.wake();
    } else {
        views_.orbit.zoom(notches);
        turned();
    }
}

void Viewer::keep() {
    if (feeling_.is_pressing()) return;
    views_.wake();
    if (!holds_.has_own()) return let_go();
    holds_.leave();
    drag_ = Drag::none;
    message_.say("it stays there; K again lets go");
}

void Viewer::frame_selection() {
    if (!experiment()) return;
    const Bounds box = bounds(selected_);
    views_.orbit.frame(box.empty() ? bounds_of(experiment()->play().skins()) : box);
    selected_.clear();
    turned();
}

void Viewer::reset_camera() {
    views_.orbit.reset();
    turned();
}

// ---- for drawing ----

std::vector<Arrow> Viewer::arrows() const {
    if (!experiment()) return {};
    std::vector<Arrow> arrows = holds_.arrows(experiment()->play().interaction_forces());
    if (const auto arrow = feeling_.arrow(); arrow && shows_tip()) arrows.push_back(*arrow);
    return arrows;
}

Traces Viewer::traces() const {
    const Play& play = experiment()->play();
    Traces traces;
    holds_.add_to(traces, play, options.tip);
    if (shows_tip()) feeling_.add_to(traces, play.skins().size(), options.tip);
    return traces;
}

void Viewer::look() {
    if (experiment()) views_.look(traces(), shows_tip() || filming(), !filming());
}

void Viewer::draw() {
    if (!experiment()) return;
    const auto took = views_.draw();
    if (took && !options.paused) readings_.draw.add(*took);
}

Image Viewer::image() { return experiment() ? views_.image(traces()) : Image{}; }

void Viewer::save(Output what) {
    if (!experiment()) return;
    message_.attempt([&] { saving_.save(what, *experiment(), folder, [&] { return image(); }); });
}

}  // namespace palpate
