#include "palpate/run/tip.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {

std::optional<float> way_to_touch(vec3 from, vec3 along, float radius, const std::vector<Skin>& skins) {
    std::optional<float> nearest;
    for (const Skin& skin : skins)
        for (vec3 v : skin.positions) {
            const float ahead = glm::dot(v - from, along);
            const vec3 aside = v - from - ahead * along;
            const float room = radius * radius - glm::dot(aside, aside);
            if (room < 0) continue;
            const float way = ahead - std::sqrt(room);
            if (!nearest || way < *nearest) nearest = way;
        }
    return nearest;
}

std::optional<Press> Tip::press(double time, double frame, const std::vector<Skin>& skins) {
    if (!within(recipe_.path, time)) return std::nullopt;
    if (untouched_.empty()) {
        untouched_ = skins;
        if (recipe_.from) {
            const vec3 along = glm::normalize(recipe_.along);
            const auto way = way_to_touch(*recipe_.from, along, recipe_.radius, skins);
            if (!way)
                throw Error("the tip meets no surface on its way", "tool " + recipe_.name,
                            "change its `from` or `along`, so that a body lies ahead");
            origin_ = *recipe_.from + *way * along;
        }
    }
    const vec3 here = centre(time), there = centre(time + frame);
    return Press{here, (there - here) / float(frame), recipe_.radius, recipe_.stiffness};
}

double Tip::indentation(vec3 centre, const std::vector<Skin>& skins) const {
    float deepest = 0;
    const float reach = 1.2f * recipe_.radius;
    for (std::size_t s = 0; s < untouched_.size(); ++s)
        for (std::size_t i = 0; i < skins[s].positions.size(); ++i) {
            const vec3 now = skins[s].positions[i];
            if (glm::distance(now, centre) > reach) continue;
            deepest = std::max(deepest, glm::dot(untouched_[s].positions[i] - now, untouched_[s].normals[i]));
        }
    return deepest;
}

}  // namespace palpate
