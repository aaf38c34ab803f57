#include "palpate/viewer/holds.h"

namespace palpate {

std::vector<Hold> Holds::all() const {
    std::vector<Hold> all = left_;
    if (own_) all.push_back(*own_);
    if (device_) all.push_back(*device_);
    return all;
}

bool Holds::room_for(const Experiment& experiment, const Hold& hold) const {
    std::vector<Hold> all = this->all();
    all.push_back(hold);
    Hands hands;
    for (Hold& one : all) one.add_to(hands);
    return experiment.takes(hands);
}

bool Holds::take(const Experiment& experiment, const Hold& hold, const Sight& sight) {
    if (!room_for(experiment, hold)) return false;
    own_ = hold;
    depth_ = sight.depth_of(hold.target());
    return true;
}

void Holds::follow(const Sight& sight) {
    if (own_) own_->go_to(sight.at_depth(depth_));
}

void Holds::leave() {
    if (own_) left_.push_back(*own_);
    own_.reset();
}

void Holds::release() { own_.reset(); }

void Holds::clear() {
    left_.clear();
    own_.reset();
    device_.reset();
}

void Holds::keep_fitting(const Experiment& experiment) {
    std::erase_if(left_, [&](const Hold& hold) { return !hold.fits(experiment); });
    for (auto* one : {&own_, &device_})
        if (*one && !(*one)->fits(experiment)) one->reset();
}

void Holds::follow(const Experiment& experiment, const std::optional<Felt>& felt, const Options& options) {
    const bool presses = options.mode == Mode::press;
    const bool lets_go = !felt || (!presses && felt->buttons & 1);
    if (lets_go || (device_ && device_->presses() != presses)) device_.reset();
    if (lets_go || felt->time == 0) return;
    const vec3 place(felt->pose.place);
    std::optional<Hold> begun;
    if (!device_ && presses) {
        begun = Hold::tip(experiment, 0, place, options.tip);
    } else if (!device_ && felt->count > felt->lasting) {
        const auto touched = std::size_t(felt->surfaces[std::size_t(felt->lasting)]);
        if (touched < experiment.models().models.size())
            begun = Hold::pulling(experiment, {.surface = touched, .place = place});
    }
    if (begun && room_for(experiment, *begun)) device_ = begun;
    if (device_) device_->go_to(place);
}

void Holds::add_to(Hands& hands) {
    for (Hold& hold : left_) hold.add_to(hands);
    if (own_) own_->add_to(hands);
    if (device_) device_->add_to(hands);
}

std::vector<Arrow> Holds::arrows(const Pushes& pushes) const {
    std::vector<Arrow> arrows;
    std::size_t press = 0, pull = 0;
    for (const Hold& hold : all()) {
        arrows.push_back({hold.place(), vec3(hold.force(pushes, hold.presses() ? press : pull))});
        (hold.presses() ? press : pull) += hold.presses() ? 1 : hold.pulls();
    }
    return arrows;
}

void Holds::add_to(Traces& traces, const Play& play, float tip) const {
    for (const Hold& hold : all()) {
        traces.balls.push_back({hold.place(), hold.presses() ? hold.radius() : 0.25f * tip, hand_colour});
        if (!hold.presses()) traces.add_line(hold.held(play), hold.place());
    }
}

}  // namespace palpate
