#include "palpate/run/tip.h"

#include "palpate/base/error.h"
#include "palpate/mesh/triangle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

namespace {

struct Triangle {
    vec3 a, b, c;
    float distance(vec3 p) const {
        const vec3 w = nearest_weights(p, a, b, c);
        return glm::distance(p, w.x * a + w.y * b + w.z * c);
    }
};

// Broad phase: the triangles that a moving ball may touch, because their bounding spheres are near its path,
// ahead.
std::vector<Triangle> ahead(vec3 from, vec3 along, float radius, const std::vector<Skin>& skins) {
    std::vector<Triangle> triangles;
    for (const Skin& skin : skins)
        for (uvec3 t : *skin.triangles) {
            const vec3 a = skin.positions[t.x], b = skin.positions[t.y], c = skin.positions[t.z];
            const vec3 centre = (a + b + c) / 3.0f;
            const float size =
                std::max({glm::distance(a, centre), glm::distance(b, centre), glm::distance(c, centre)});
            const float way = glm::dot(centre - from, along);
            const float aside = glm::distance(centre, from + way * along);
            if (way > -size && aside < radius + size) triangles.push_back({a, b, c});
        }
    return triangles;
}

}  // namespace

std::optional<float> way_to_touch(vec3 from, vec3 along, float radius, const std::vector<Skin>& skins) {
    const std::vector<Triangle> triangles = ahead(from, along, radius, skins);
    if (triangles.empty()) return std::nullopt;
    float farthest = 0;
    for (const Triangle& t : triangles) farthest = std::max(farthest, t.distance(from) + radius);
    // Conservative advancement (sphere tracing): the ball may always move by its distance to the nearest
    // triangle without passing through any.
    float way = 0;
    for (int i = 0; i < 1000 && way <= farthest; ++i) {
        float room = std::numeric_limits<float>::max();
        for (const Triangle& t : triangles) room = std::min(room, t.distance(from + way * along) - radius);
        if (i == 0 && room < 0) return std::nullopt;
        if (room < 1e-3f * radius) return way;
        way += room;
    }
    return std::nullopt;
}

vec3 brought_to_touch(const ToolRecipe& recipe, const std::string& file, const std::vector<Skin>& skins) {
    const vec3 along = glm::normalize(recipe.along);
    const auto way = way_to_touch(*recipe.from, along, recipe.radius, skins);
    if (!way)
        throw Error(fmt::format("tool.{}.from: the tip meets no surface on its way, or starts inside one,",
                                recipe.name),
                    recipe.lines.where("from", file), "change from or along, so that a body lies ahead");
    return *recipe.from + *way * along;
}

Press Tip::press(double time, double frame, const std::vector<Skin>& skins) {
    if (untouched_.empty()) {
        untouched_ = skins;
        if (recipe_.from) origin_ = brought_to_touch(recipe_, file_, skins);
    }
    const vec3 here = centre(time), there = centre(time + frame);
    return {
        here,           (there - here) / float(frame), recipe_.radius, recipe_.stiffness, recipe_.friction,
        recipe_.damping};
}

double indentation(const std::vector<Skin>& untouched, const std::vector<Skin>& now, vec3 centre,
                   float radius) {
    float deepest = 0;
    const float reach = 1.2f * radius;
    for (std::size_t s = 0; s < untouched.size(); ++s)
        for (std::size_t i = 0; i < now[s].positions.size(); ++i) {
            const vec3 place = now[s].positions[i];
            if (glm::distance(place, centre) > reach) continue;
            const float way = glm::dot(untouched[s].positions[i] - place, untouched[s].normals[i]);
            deepest = std::max(deepest, now[s].is_sheet ? std::abs(way) : way);
        }
    return deepest;
}

}  // namespace palpate
