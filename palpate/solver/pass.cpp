#include "palpate/solver/pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

// A frame in which a shape is simple, and its size there.
struct ShapeFrame {
    vec3 origin = vec3(0);
    mat3 axes = mat3(1);
    int kind = round_box;
    vec4 size = vec4(0);
    float half_thickness = 1e18f;  // m; of what has no other side
    float reach = 0;               // m, from the origin to its farthest point
    float skin = 0;                // m, on top of it
};

// Three axes at right angles, the second of them along y.
mat3 axes_around(vec3 y) {
    const vec3 x = glm::normalize(glm::cross(y, std::abs(y.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 0, 1)));
    return {x, y, glm::cross(x, y)};
}

ShapeFrame frame(const Plane& plane) {
    return {plane.normal * plane.offset, axes_around(plane.normal), half_space};
}
ShapeFrame rounded(vec3 origin, const mat3& axes, vec3 half, float rounding) {
    return {origin,
            axes,
            round_box,
            vec4(half, rounding),
            std::min({half.x, half.y, half.z}) + rounding,
            glm::length(half) + rounding};
}
ShapeFrame frame(const Sphere& sphere) { return rounded(sphere.centre, mat3(1), vec3(0), sphere.radius); }
ShapeFrame frame(const Capsule& capsule) {
    const vec3 along = capsule.to - capsule.from;
    const float length = glm::length(along);
    return rounded(0.5f * (capsule.from + capsule.to), length > 0 ? axes_around(along / length) : mat3(1),
                   vec3(0, length / 2, 0), capsule.radius);
}
ShapeFrame frame(const Box& box) {
    return rounded(box.centre, {box.axes[0], box.axes[1], box.axes[2]}, box.half, box.rounding);
}
// A polygon looks at the way of every node anyway.
ShapeFrame frame(const Polygon& polygon) { return {.kind = palpate::polygon, .skin = polygon.thickness}; }
// Walls thinner than two spacings a field does not show (scene/thin_walls.h).
ShapeFrame frame(const DistanceField& f) {
    const vec3 last = f.origin + f.spacing * vec3(f.dims - 1);
    return {.kind = field,
            .half_thickness = f.spacing,
            .reach = glm::length(glm::max(glm::abs(f.origin), glm::abs(last)))};
}

// A node that goes less far than half through it in `seconds`, the pass, is nearest to the side it came from.
Obstacle obstacle(const Collider& collider, const Motion& motion, float seconds) {
    const ShapeFrame shape = std::visit([](const auto& s) { return frame(s); }, collider.shape);
    const vec3 way = motion.rotation * shape.origin, origin = motion.position + way;
    const mat3 axes = motion.rotation * shape.axes;
    auto row = [&](vec3 axis) { return vec4(axis, -glm::dot(axis, origin)); };
    const vec3 velocity = motion.velocity + glm::cross(motion.spin, way);
    const float own_speed = glm::length(velocity) + glm::length(motion.spin) * shape.reach,
                clear = std::max(shape.half_thickness + collider.margin - seconds * own_speed, 0.0f);
    return {row(axes[0]),
            row(axes[1]),
            row(axes[2]),
            shape.size,
            vec4(origin, shape.skin + collider.margin),
            vec4(velocity, collider.friction),
            vec4(motion.spin, clear),
            ivec4(shape.kind, 0, 0, 0)};
}

}  // namespace

Pass make_pass(const Body& body, const Simulation& simulation, const Origin& origin) {
    Pass pass{};
    // Damping brakes the origin's speed too.
    pass.gravity = vec4(simulation.gravity - body.damping * vec3(origin.velocity), 0);
    pass.origin_speed = vec4(vec3(origin.velocity), 0);
    pass.damping = body.damping;
    pass.link_damping = body.link_damping;
    pass.fan = body.fan;
    if (const GridSprings* grid = body.grid()) {
        pass.links = int(grid->links.size());
        assert(grid->links.size() <= std::size(pass.spring));
        for (int l = 0; l < pass.links; ++l) {
            const Link& link = grid->links[l];
            pass.spring[l] = {link.stiffness, link.stiffness * link.rest, torn_at(link.rest, body), 0};
        }
    }
    if (const TissueCells* cells = tissue_of(body)) {
        pass.shear = cells->shear();
        pass.lame = cells->lame();
        pass.cell_size = body.spacing;
        pass.bend = cells->youngs_modulus * body.spacing / 48;
        pass.twist = cells->shear() * body.spacing / 16;
    }
    return pass;
}

void place_tips(std::vector<RoundTip>& tips, const Influences& influences, double time) {
    tips.clear();
    for (const Press& press : influences.presses)
        tips.push_back({vec4(press.centre + float(time) * press.velocity, press.radius),
                        vec4(pressure_per_metre(press), press.damping / cross_section(press),
                             float(press.friction.still), float(press.friction.sliding)),
                        vec4(press.velocity, 0)});
}

void place_obstacles(Pass& pass, const Simulation& simulation, const Influences& influences, double time,
                     const Origin& origin) {
    assert(influences.colliders.empty() || influences.colliders.size() == simulation.colliders.size());
    assert(simulation.colliders.size() <= std::size(pass.obstacle));
    pass.obstacles = int(simulation.colliders.size());
    int corners = 0, fields = 0;
    for (int i = 0; i < pass.obstacles; ++i) {
        const Collider& collider = simulation.colliders[i];
        Motion motion = influences.colliders.empty() ? Motion{} : influences.colliders[i];
        motion.position = vec3(dvec3(motion.position) - origin.place);
        motion.velocity = vec3(dvec3(motion.velocity) - origin.velocity);
        pass.obstacle[i] = obstacle(collider, after(motion, float(time)), pass.duration);
        ivec4& kind = pass.obstacle[i].kind;
        if (const auto* polygon = std::get_if<Polygon>(&collider.shape)) {
            kind.y = corners;
            kind.z = int(3 * polygon->triangles.size());
            corners += kind.z;
        }
        if (std::holds_alternative<DistanceField>(collider.shape)) kind.y = fields++;
    }
}

std::vector<vec3> polygon_corners(const Simulation& simulation) {
    std::vector<vec3> corners;
    for (const Collider& collider : simulation.colliders)
        if (const auto* polygon = std::get_if<Polygon>(&collider.shape))
            for (const auto& triangle : polygon->triangles)
                corners.insert(corners.end(), triangle.begin(), triangle.end());
    return corners;
}

std::vector<const DistanceField*> distance_fields(const Simulation& simulation) {
    std::vector<const DistanceField*> fields;
    for (const Collider& collider : simulation.colliders)
        if (const auto* one = std::get_if<DistanceField>(&collider.shape)) fields.push_back(one);
    return fields;
}

}  // namespace palpate
