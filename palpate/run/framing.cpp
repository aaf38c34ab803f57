#include "palpate/run/framing.h"

#include "palpate/run/bounding_box.h"
#include "palpate/run/tip.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

// How far around the bodies' bounding box other things count, in diagonals of it: the part that is near, the
// nearest point of what is within reach, and the ground on which a body may fall.
constexpr float near = 0.5f, reach = 2, fall = 6;
constexpr float margin = 1.1f;  // a border around what must be seen

using Points = std::vector<vec3>;

bool holds(const Bounds& box, vec3 p) { return glm::clamp(p, box.low, box.high) == p; }

Bounds grown(Bounds box, float by) {
    box.low -= by;
    box.high += by;
    return box;
}

std::array<vec3, 8> corners(const Bounds& box) {
    std::array<vec3, 8> all;
    for (int i = 0; i < 8; ++i)
        all[std::size_t(i)] = glm::mix(box.low, box.high, vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
    return all;
}

// ---- what shall be seen ----

// A body without a surface counts by its nodes.
const Points& shown(const Model& model) {
    return model.surface.positions.empty() ? model.body.positions : model.surface.positions;
}

// Bodies and surfaces, and where prescribed motion takes nodes.
Points subjects(const Scene& scene, const Models& made) {
    Points points;
    auto add = [&](const Points& more) { points.insert(points.end(), more.begin(), more.end()); };
    for (const Model& model : made.models) add(shown(model));
    for (const StaticSurface& still : made.static_surfaces) add(still.surface.positions);
    for (std::size_t i = 0; i < made.moves.size(); ++i) {
        const MovedNodes& moved = made.moves[i];
        const Points& rest = made.models[moved.body].body.positions;
        for (const Waypoint& waypoint : scene.moves[i].path)
            for (const int node : moved.nodes)
                points.push_back(moved.about + waypoint.position +
                                 turn(waypoint.rotation) * (rest[std::size_t(node)] - moved.about));
    }
    return points;
}

// The motion of a collider over time.
std::vector<Pose> poses(const ColliderRecipe& recipe, vec3 pivot) {
    if (recipe.path.empty()) return {Pose{}};
    std::vector<Pose> all;
    for (const Waypoint& waypoint : recipe.path) {
        all.push_back(pose(waypoint));
        all.back().place += dvec3(pivot);
    }
    return all;
}

// The origin of the positions of a tool's path.
vec3 origin_of(const ToolRecipe& tool, const Models& made) {
    if (tool.from) {
        std::vector<Skin> skins;
        for (const Model& model : made.models)
            skins.push_back({model.surface.positions, {}, &model.surface.triangles});
        for (const StaticSurface& still : made.static_surfaces)
            skins.push_back({still.surface.positions, {}, &still.surface.triangles});
        const vec3 along = glm::normalize(tool.along);
        return *tool.from + way_to_touch(*tool.from, along, tool.radius, skins).value_or(0) * along;
    }
    if (!tool.relative) return vec3(0);
    const vec3 place = tool.near.value_or(tool.path.front().position);
    vec3 nearest(INFINITY);
    for (const Model& model : made.models)
        if (tool.body.empty() || model.body.name == tool.body)
            for (vec3 p : model.body.positions)
                if (glm::distance(p, place) < glm::distance(nearest, place)) nearest = p;
    return std::isfinite(nearest.x) ? nearest : vec3(0);
}

// Everything that shall be in the picture.
struct Seen {
    Points points;
    Bounds box;           // of the bodies
    vec3 tips = vec3(0);  // the mean offset of the tips from its centre, m

    Seen(const Scene& scene, const Models& made);

 private:
    void add(const Bounds& thing);
    void add(const Plane& plane, const Pose& at);
    void add_colliders(const Scene& scene, const Models& made);
    void add_tips(const Scene& scene, const Models& made);

    Bounds near_, reach_;
};

Seen::Seen(const Scene& scene, const Models& made) : points(subjects(scene, made)), box(bounds(points)) {
    if (box.empty()) near_ = reach_ = {vec3(-1e6f), vec3(1e6f)};  // then everything else counts
    if (!box.empty()) {
        const float size = glm::length(box.size());
        near_ = grown(box, near * size);
        reach_ = grown(box, reach * size);
        const float pull = glm::length(scene.simulation.gravity);
        const bool falls = std::ranges::any_of(made.models, [](const Model& model) {
            return std::ranges::all_of(model.body.inverse_mass, [](float m) { return m > 0; });
        });
        if (pull > 0 && falls)
            for (vec3 corner : corners(box))
                reach_.include(corner + fall * size / pull * scene.simulation.gravity);
    }
    add_colliders(scene, made);
    add_tips(scene, made);
    if (box.empty()) box = bounds(points);
}

// The part of it that is near, and its nearest point.
void Seen::add(const Bounds& thing) {
    const Bounds part{glm::max(thing.low, near_.low), glm::min(thing.high, near_.high)};
    if (glm::all(glm::lessThanEqual(part.low, part.high)))
        for (vec3 corner : corners(part)) points.push_back(corner);
    const vec3 nearest = glm::clamp(box.empty() ? vec3(0) : box.centre(), thing.low, thing.high);
    if (holds(reach_, nearest)) points.push_back(nearest);
}

// The area on which the bodies would stand.
void Seen::add(const Plane& plane, const Pose& at) {
    if (box.empty()) return;
    const vec3 normal(at.turn * dvec3(plane.normal));
    const float offset = plane.offset + glm::dot(normal, vec3(at.place));
    for (vec3 corner : corners(box)) {
        const vec3 foot = corner - (glm::dot(normal, corner) - offset) * normal;
        if (holds(reach_, foot)) points.push_back(foot);
    }
}

void Seen::add_colliders(const Scene& scene, const Models& made) {
    for (std::size_t c = 0; c < made.simulation.colliders.size(); ++c)
        for (const Pose& at : poses(scene.colliders[c], made.pivots[c])) {
            const auto& shape = made.simulation.colliders[c].shape;
            if (const auto* plane = std::get_if<Plane>(&shape)) add(*plane, at);
            const std::optional<Box> rest = bounding_box(made.simulation.colliders[c]);
            if (!rest) continue;
            Bounds posed;
            for (vec3 corner : corners({-rest->half, rest->half})) {
                const vec3 p = rest->centre + mat3(rest->axes[0], rest->axes[1], rest->axes[2]) * corner;
                posed.include(vec3(at.of(dvec3(p))));
            }
            add(grown(posed, rest->rounding));
        }
}

void Seen::add_tips(const Scene& scene, const Models& made) {
    int count = 0;
    for (const ToolRecipe& tool : scene.tools) {
        if (tool.path.empty()) continue;
        const vec3 origin = origin_of(tool, made);
        for (const Waypoint& waypoint : tool.path) {
            const vec3 centre = origin + waypoint.position;
            if (!holds(reach_, centre)) continue;
            for (vec3 corner : corners({centre - tool.radius, centre + tool.radius}))
                points.push_back(corner);
            if (!box.empty()) tips += centre - box.centre(), ++count;
        }
    }
    if (count > 0) tips /= float(count);
}

// ---- the eye ----

// The direction to the eye, unit. `axes`: right, up and towards the viewer, for something that stands
// upright.
vec3 side(const Seen& seen, const mat3& axes) {
    vec3 low(INFINITY), high(-INFINITY);
    for (vec3 p : seen.points) {
        low = glm::min(low, p * axes);
        high = glm::max(high, p * axes);
    }
    const vec3 size = high - low, tips = seen.tips * axes;
    vec3 way(0.3f, 0.2f, 0.4f);
    if (size.z > 1.5f * size.x) std::swap(way.x, way.z);
    if (size.y < 0.25f * std::max(size.x, size.z)) way.y = 0.35f;
    for (int axis : {0, 2})
        if (tips[axis] < -0.25f * size[axis]) way[axis] = -way[axis];
    return axes * glm::normalize(way);
}

// The nearest eye that looks along -`back` and has all points in its view frustum: each side of the frustum
// touches one of them, or there is equal room on two opposite sides. `fixed`: the point to look at.
Camera fitted(Camera camera, const Points& points, vec3 back, float aspect, std::optional<vec3> fixed) {
    const vec3 middle = fixed.value_or(bounds(points).centre());
    vec3 aside = glm::cross(camera.up, back);
    if (glm::length(aside) < 1e-4f)
        aside = glm::cross(std::abs(back.z) < 0.7f ? vec3(0, 0, 1) : vec3(1, 0, 0), back);
    const vec3 right = glm::normalize(aside), up = glm::cross(back, right);
    const float slope = std::tan(0.5f * glm::radians(camera.angle)) / margin;
    const vec2 slopes(slope * aspect, slope);
    // How far the eye must be for the points to lie within the left, lower, right and upper plane of the
    // frustum.
    vec2 low(-INFINITY), high(-INFINITY);
    for (vec3 p : points) {
        const vec2 off = vec2(glm::dot(p - middle, right), glm::dot(p - middle, up)) / slopes;
        const float depth = camera.orthographic ? 0 : glm::dot(p - middle, back);
        low = glm::max(low, depth - off);
        high = glm::max(high, depth + off);
    }
    const vec2 shift = fixed ? vec2(0) : 0.5f * (high - low) * slopes;
    const vec2 distances = fixed ? glm::max(low, high) : 0.5f * (low + high);
    camera.look_at = middle + shift.x * right + shift.y * up;
    camera.eye = camera.look_at + std::max({distances.x, distances.y, 1e-4f}) * back;
    return camera;
}

// What the scene looks at; nothing if it does not say.
std::optional<vec3> looked_at(const Scene& scene, const Models& made) {
    if (const auto* point = std::get_if<vec3>(&scene.camera.look_at)) return *point;
    const auto* name = std::get_if<std::string>(&scene.camera.look_at);
    if (!name) return std::nullopt;
    std::optional<vec3> at;
    for (const Model& model : made.models)
        if (model.body.name == *name) at = bounds(shown(model)).centre();
    for (const StaticSurface& still : made.static_surfaces)
        if (still.name == *name) at = bounds(still.surface).centre();
    return at;
}

}  // namespace

Camera camera_of(const Scene& scene, const Models& made, float aspect) {
    Camera camera{.angle = scene.camera.angle, .orthographic = scene.camera.orthographic};
    camera.up = sky(scene);
    const std::optional<vec3> at = looked_at(scene, made);
    camera.look_at = at.value_or(vec3(0));
    camera.eye = scene.camera.eye.value_or(camera.eye);
    if (scene.camera.eye && at) return camera;
    const Seen seen(scene, made);
    if (seen.points.empty()) return camera;
    if (!scene.camera.eye) return fitted(camera, seen.points, side(seen, upright(camera.up)), aspect, at);
    camera.look_at = bounds(seen.points).centre();
    return camera;
}

}  // namespace palpate
