#include "app/viewer/hand.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/run/run.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t most_threads_of_a_hold = 4;  // of the 8 drags that a body takes
constexpr float beyond = 0.04f;  // m around a hand that it knows: it goes no farther before the next picture

float width_of(const Body& body) {
    Bounds box;
    for (vec3 p : body.positions) box.include(p);
    return glm::length(box.size());
}

}  // namespace

// ---- holds ----

Hold Hold::pulling(const Experiment& experiment, const Hit& hit) {
    const Body& body = experiment.models().models[hit.surface].body;
    const auto positions = experiment.play().nodes(hit.surface).positions;
    std::vector<int> nearest;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.inverse_mass[i] > 0) nearest.push_back(int(i));
    const std::size_t count = std::min(nearest.size(), most_threads_of_a_hold);
    auto distance = [&](int node) { return glm::distance(positions[std::size_t(node)], hit.place); };
    std::partial_sort(nearest.begin(), nearest.begin() + std::ptrdiff_t(count), nearest.end(),
                      [&](int a, int b) { return distance(a) < distance(b); });
    nearest.resize(count);
    Hold hold;
    const float strength = strength_for(body).pull;
    for (int node : nearest)
        if (distance(node) < distance(nearest[0]) + 1.5f * body.spacing)
            hold.threads_.push_back({node, positions[std::size_t(node)] - hit.place,
                                     strength / body.inverse_mass[std::size_t(node)]});
    if (hold.threads_.empty())
        throw Error("no node to pull that is free", "body " + body.name, "let go of some pins");
    hold.body_ = hit.surface;
    hold.nodes_ = body.count();
    hold.fastest_ = 3 * width_of(body);
    hold.place_ = hold.target_ = hit.place;
    return hold;
}

Hold Hold::tip(const Experiment& experiment, std::size_t number, vec3 place, float radius) {
    const Body& body = experiment.models().models[number].body;
    Hold hold;
    hold.body_ = number;
    hold.nodes_ = body.count();
    hold.radius_ = radius;
    hold.stiffness_ = strength_for(body).pressure * 3.14159265f * radius * radius;
    hold.fastest_ = width_of(body);
    hold.place_ = hold.target_ = place;
    return hold;
}

Hold Hold::pressing(const Experiment& experiment, const Hit& hit, const Ray& ray, float radius) {
    const vec3 before = ray.at(std::max(hit.way - 4 * radius, 0.0f));
    const float way = way_to_touch(before, ray.along, radius, experiment.play().skins())
                          .value_or(glm::distance(before, hit.place) - radius);
    Hold hold = tip(experiment, hit.surface, before + way * ray.along, radius);
    hold.go_to(hold.place_ + 0.5f * radius * ray.along);
    return hold;
}

void Hold::add_to(Hands& hands) {
    const vec3 wish = target_ - place_;
    const float most = fastest_ * float(frame_seconds), length = glm::length(wish);
    const vec3 step = length > most ? wish * (most / length) : wish;
    const vec3 velocity = step / float(frame_seconds);
    if (presses()) hands.presses.push_back({place_, velocity, radius_, stiffness_});
    for (const Thread& thread : threads_)
        hands.pulls.push_back({body_, {thread.node, place_ + thread.offset, velocity, thread.stiffness}});
    place_ += step;
}

dvec3 Hold::force(const Pushes& pushes, std::size_t first) const {
    dvec3 sum(0);
    if (presses() && first < pushes.presses.size()) sum = pushes.presses[first];
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

// ---- hands that feel ----

FeelingHand::FeelingHand(std::unique_ptr<Device> device, std::vector<Feel> feels, float radius, vec3 start,
                         const std::vector<Skin>& skins, const Warmth& warmth)
    : touch_(std::move(device), {.radius = radius, .feels = std::move(feels)}, warmth) {
    feel(skins, start);
    loop_.emplace(std::vector<Touch*>{&touch_});
}

void FeelingHand::set(std::vector<Feel> feels, float radius) {
    touch_.set({.radius = radius, .feels = std::move(feels)});
}

void FeelingHand::begin_anew() {
    expect_jump();
    begins_anew_ = true;
}

// Nothing is left of the old surfaces only once the touch knows the new ones.
void FeelingHand::feel(const std::vector<Skin>& skins) {
    felt_ = touch_.felt();
    feel(skins, felt_.proxy);
    if (begins_anew_) touch_.begin_anew();
    begins_anew_ = false;
}

std::string FeelingHand::granted() const { return loop_->granted().schedule; }

void FeelingHand::feel(const std::vector<Skin>& skins, vec3 around) {
    const double time = now();
    const auto seconds = float(std::max(time - felt_at_, 1e-4));
    std::vector<std::vector<vec3>> velocities(skins.size());
    for (std::size_t s = 0; s < skins.size() && s < before_.size(); ++s) {
        const std::vector<vec3>& here = skins[s].positions;
        if (before_[s].size() != here.size() || seconds > 0.5f) continue;
        velocities[s].resize(here.size());
        for (std::size_t i = 0; i < here.size(); ++i) velocities[s][i] = (here[i] - before_[s][i]) / seconds;
    }
    std::vector<Touchable> surfaces;
    for (std::size_t s = 0; s < skins.size(); ++s)
        surfaces.push_back({skins[s].positions, *skins[s].triangles, velocities[s], skins[s].is_sheet});
    touch_.feel(Patch(surfaces, around, beyond, time));
    before_.resize(skins.size());
    for (std::size_t s = 0; s < skins.size(); ++s) before_[s] = skins[s].positions;
    felt_at_ = time;
}

}  // namespace palpate
