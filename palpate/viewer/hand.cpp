#include "palpate/viewer/hand.h"

#include "palpate/base/error.h"
#include "palpate/run/run.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t most_threads_of_a_hold = 4;  // of the 8 drags that a body takes

float width_of(const Body& body) { return glm::length(bounds(body.positions).size()); }

}  // namespace

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

}  // namespace palpate
