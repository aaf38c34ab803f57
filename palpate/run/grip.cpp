#include "palpate/run/grip.h"

#include "palpate/base/error.h"

#include <limits>

namespace palpate {

std::optional<NodePush> Grip::drag(double time, double frame, const std::vector<Model>& models,
                                   const World& world) {
    if (!within(recipe_.path, time)) return std::nullopt;
    if (node_ < 0) take_hold(models, world);
    const vec3 here = centre(time), there = centre(time + frame);
    return NodePush{node_, here, (there - here) / float(frame), recipe_.stiffness};
}

void Grip::take_hold(const std::vector<Model>& models, const World& world) {
    const vec3 point = recipe_.near.value_or(recipe_.path.front().position);
    float nearest = std::numeric_limits<float>::max();
    vec3 held(0);
    for (std::size_t m = 0; m < models.size(); ++m) {
        const Body& body = models[m].body;
        if (!recipe_.body.empty() && body.name != recipe_.body) continue;
        const auto positions = world.solver(m).nodes().positions;
        for (std::size_t i = 0; i < body.count(); ++i) {
            const float distance = glm::distance(positions[i], point);
            if (!(body.inverse_mass[i] > 0) || !(distance < nearest)) continue;
            nearest = distance;
            body_ = m;
            node_ = int(i);
            held = positions[i];
        }
    }
    if (node_ < 0)
        throw Error("all nodes that could be dragged are pinned", "tool " + recipe_.name,
                    "name another body, or pin less of it");
    if (recipe_.relative) origin_ = held;
}

}  // namespace palpate
