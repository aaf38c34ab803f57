#include "palpate/solver/check.h"

#include "palpate/base/error.h"
#include "palpate/solver/pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace palpate {
namespace {

constexpr std::size_t most_triangles = 1000;

bool is_some(double value) { return value >= 0 && std::isfinite(value); }
bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_numbers(const Simulation& simulation) {
    auto require = [](bool holds, std::string_view what, std::string_view remedy) {
        if (!holds) throw Error(what, "the simulation", remedy);
    };
    require(simulation.threads >= 1 && simulation.threads <= most_threads,
            fmt::format("{} threads", simulation.threads), fmt::format("use 1 to {}", most_threads));
    require(is_some(simulation.step), "a step that is negative or not finite",
            "give it in s, or 0 to have one chosen");
    require(is_finite(simulation.gravity), "a gravity that is not finite", "give it in m/s²");
    require(is_some(simulation.air), "air whose density is negative or not finite",
            "use 1.2 kg/m³, or 0 for none");
    require(is_some(simulation.shortest_step), "a shortest step that is negative or not finite",
            "give it in s, or 0 to accept any");
}

// Nothing where a shape is one that nodes can be kept out of; else what is wrong with it.
const char* fault(const Plane& plane) {
    return is_finite(plane.normal) && glm::length(plane.normal) > 0 && std::isfinite(plane.offset)
               ? nullptr
               : "a plane without a normal";
}
const char* fault(const Sphere& sphere) {
    return is_finite(sphere.centre) && sphere.radius >= 0 && std::isfinite(sphere.radius)
               ? nullptr
               : "a sphere whose radius is negative or not finite";
}
const char* fault(const Capsule& capsule) {
    return is_finite(capsule.from) && is_finite(capsule.to) && capsule.radius >= 0 &&
                   std::isfinite(capsule.radius)
               ? nullptr
               : "a capsule whose radius is negative or not finite";
}
const char* fault(const Box& box) {
    const bool is_sound = is_finite(box.centre) && is_finite(box.half) && box.rounding >= 0 &&
                          std::isfinite(box.rounding) && glm::all(glm::greaterThanEqual(box.half, vec3(0))) &&
                          std::ranges::all_of(box.axes, is_finite);
    return is_sound ? nullptr : "a box whose sides are negative or not finite";
}
const char* fault(const Polygon& polygon) {
    const bool is_sound = polygon.thickness >= 0 && std::isfinite(polygon.thickness) &&
                          std::ranges::all_of(polygon.triangles, [](const auto& t) {
                              return std::ranges::all_of(t, is_finite);
                          });
    return is_sound ? nullptr : "a polygon whose corners or thickness are not finite";
}
const char* fault(const DistanceField& field) {
    const auto [x, y, z] = std::array{field.dims.x, field.dims.y, field.dims.z};
    const bool is_sound = std::min({x, y, z}) >= 2 && field.spacing > 0 && std::isfinite(field.spacing) &&
                          is_finite(field.origin) &&
                          double(field.distance.size()) == double(x) * double(y) * double(z);
    return is_sound ? nullptr : "a distance field of another number of points than its dims say";
}

void check_colliders(const Simulation& simulation) {
    for (const Collider& collider : simulation.colliders) {
        if (const char* what = std::visit([](const auto& shape) { return fault(shape); }, collider.shape))
            throw Error(what, "the colliders", "give it all its numbers, in m");
        if (!(collider.friction >= 0 && std::isfinite(collider.friction) && std::isfinite(collider.margin)))
            throw Error("a friction that is negative or not finite, or such a margin", "the colliders",
                        "use 0 or more");
    }
    if (simulation.colliders.size() > std::size(Pass{}.obstacle))
        throw Error(fmt::format("{} colliders", simulation.colliders.size()), "the colliders",
                    fmt::format("use at most {}", std::size(Pass{}.obstacle)));
    if (const std::size_t corners = polygon_corners(simulation).size(); corners > 3 * most_triangles)
        throw Error(fmt::format("{} triangles in polygons", corners / 3), "the colliders",
                    fmt::format("use at most {}, or the distance field of a closed mesh", most_triangles));
}

}  // namespace

void check(const Body& body, const Simulation& simulation) {
    check(body);
    check_numbers(simulation);
    check_colliders(simulation);
}

void check(double seconds, const Influences& influences, const Body& body, const Simulation& simulation) {
    auto require = [&](bool holds, std::string_view what, std::string_view remedy) {
        if (!holds) throw Error(what, "a step of " + name_in_errors(body), remedy);
    };
    auto has = [&](int node) { return node >= 0 && std::size_t(node) < body.count(); };
    require(seconds > 0 && std::isfinite(seconds), "a time that is not above 0 s", "step by more");
    for (const Press& press : influences.presses) {
        require(is_finite(press.centre) && is_finite(press.velocity) && press.radius > 0 &&
                    std::isfinite(press.radius) && press.stiffness >= 0 && std::isfinite(press.stiffness),
                "a press that is not finite, or has no radius, or a negative stiffness", "give it all three");
        require(is_some(float(press.friction.still)) && is_some(press.friction.sliding) &&
                    is_some(press.damping / cross_section(press)),
                "a press whose friction or damping is negative or not finite", "use 0 or more");
        require(press.friction.sliding <= press.friction.still,
                "a press with more friction when it slides than when it sticks", "use the same for both");
    }
    for (const NodePush& push : influences.pushes) {
        require(has(push.node), "a push of a node that the body does not have", "count its nodes from 0");
        require(is_finite(push.to) && is_finite(push.velocity) && is_finite(push.force) &&
                    push.stiffness >= 0 && std::isfinite(push.stiffness),
                "a push that is not finite, or has a negative stiffness", "give it in N, m and N/m");
    }
    for (const Move& move : influences.moves) {
        require(move.nodes.size() == move.to.size(), "a move of nodes without a place for each",
                "hand in as many places as nodes");
        require(std::ranges::all_of(move.nodes, has), "a move of a node that the body does not have",
                "count its nodes from 0");
        require(std::ranges::all_of(move.to, is_finite), "a move to a place that is not finite",
                "hand in places in m");
    }
    require(influences.colliders.empty() || influences.colliders.size() == simulation.colliders.size(),
            "motions for another number of colliders than the simulation has", "hand in one each, or none");
    for (const Motion& motion : influences.colliders)
        require(is_finite(motion.position) && is_finite(motion.rotation[0]) &&
                    is_finite(motion.rotation[1]) && is_finite(motion.rotation[2]) &&
                    is_finite(motion.velocity) && is_finite(motion.spin),
                "a collider's motion that is not finite", "hand in places in m and speeds in m/s");
    require(is_finite(influences.wind), "a wind that is not finite", "give it in m/s");
    require(influences.arrival >= 0 && std::isfinite(influences.arrival),
            "an arrival that is negative or not finite", "give it in s, or 0");
}

void refuse_undo(const Body& body) {
    throw Error("no step that could be undone", name_in_errors(body), "undo each call of step() once");
}

void check(const State& state, const Body& body) {
    if (state.positions.size() == body.count() && state.velocities.size() == body.count()) return;
    throw Error("the state of another number of nodes", name_in_errors(body),
                "restore one that was saved of the same body");
}

}  // namespace palpate
