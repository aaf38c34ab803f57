#include "palpate/viewer/hold.h"

#include "palpate/base/error.h"
#include "palpate/run/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

float width_of(const Body& body) { return glm::length(bounds(body.positions).size()); }

}  // namespace

Hold Hold::pulling(const Experiment& experiment, const Hit& hit, float radius) {
    const Body& body = experiment.models().models[hit.surface].body;
    const auto positions = experiment.play().nodes(hit.surface).positions;
    auto distance = [&](std::size_t node) {
        return body.inverse_mass[node] > 0 ? glm::distance(positions[node], hit.place)
                                           : std::numeric_limits<float>::infinity();
    };
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < body.count(); ++i) nearest = std::min(nearest, distance(i));
    const float reach = std::max(radius, nearest + 1.5f * body.spacing), strength = strength_for(body).pull;
    Hold hold;
    for (std::size_t i = 0; i < body.count(); ++i) {
        if (!(distance(i) < reach)) continue;
        const float part = 1 - distance(i) * distance(i) / (reach * reach);
        hold.threads_.push_back(
            {int(i), positions[i] - hit.place, strength * part * part / body.inverse_mass[i]});
    }
    if (hold.threads_.empty()) throw Error("no free node to pull", "body " + body.name, "release some pins");
    hold.body_ = hit.surface;
    hold.nodes_ = body.count();
    hold.fastest_ = 3 * width_of(body);
    hold.place_ = hold.target_ = hit.place;
    return hold;
}

std::vector<BodyPush> Hold::pulls_at(vec3 place) const {
    std::vector<BodyPush> pulls;
    for (const Thread& thread : threads_)
        pulls.push_back({body_, {thread.node, place + thread.offset, vec3(0), thread.stiffness}});
    return pulls;
}

void Hold::add_to(Interaction& hands) {
    const vec3 wish = target_ - place_;
    const float most = fastest_ * float(frame_seconds), length = glm::length(wish);
    const vec3 step = length > most ? wish * (most / length) : wish;
    const vec3 velocity = step / float(frame_seconds);
    for (BodyPush pull : pulls_at(place_)) {
        pull.push.velocity = velocity;
        hands.pulls.push_back(pull);
    }
    place_ += step;
}

dvec3 Hold::force(const InteractionForces& pushes, std::size_t first) const {
    dvec3 sum(0);
    for (std::size_t i = 0; i < threads_.size() && first + i < pushes.pulls.size(); ++i)
        sum += pushes.pulls[first + i];
    return sum;
}

vec3 Hold::held(const Play& play) const {
    vec3 sum(0);
    for (const Thread& thread : threads_)
        sum += play.nodes(body_).positions[std::size_t(thread.node)] - thread.offset;
    return sum / float(std::max<std::size_t>(threads_.size(), 1));
}

bool Hold::fits(const Experiment& experiment) const {
    const auto& models = experiment.models().models;
    return body_ < models.size() && models[body_].body.count() == nodes_;
}

// ---- all of them ----

std::vector<Hold> Holds::all() const {
    std::vector<Hold> all = left_;
    if (own_) all.push_back(*own_);
    if (device_) all.push_back(*device_);
    return all;
}

void Holds::take(const Hold& hold, const Sight& sight) {
    own_ = hold;
    depth_ = sight.depth_of(hold.target());
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

void Holds::follow(const Experiment& experiment, const std::optional<Felt>& felt, float tip) {
    if (!felt || !(felt->buttons & 1)) return device_.reset();
    const vec3 place(felt->pose.place);
    const bool touches = felt->surface >= 0 && std::size_t(felt->surface) < experiment.models().models.size();
    if (!device_ && touches)
        device_ = Hold::pulling(experiment, {.surface = std::size_t(felt->surface), .place = place}, tip);
    if (device_) device_->put(place);
}

void Holds::add_to(Interaction& hands) {
    for (Hold& hold : left_) hold.add_to(hands);
    if (own_) own_->add_to(hands);
}

std::vector<Arrow> Holds::arrows(const InteractionForces& pushes) const {
    std::vector<Arrow> arrows;
    std::size_t pull = 0;
    for (const Hold& hold : all()) {
        arrows.push_back({hold.place(), vec3(hold.force(pushes, pull))});
        pull += hold.pulls();
    }
    return arrows;
}

void Holds::add_to(Traces& traces, const Play& play, float tip) const {
    for (const Hold& hold : all()) {
        traces.balls.push_back({hold.place(), 0.25f * tip, hand_colour});
        traces.add_line(hold.held(play), hold.place());
    }
}

}  // namespace palpate
