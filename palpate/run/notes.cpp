#include "palpate/run/notes.h"

#include "palpate/body/own_weight.h"
#include "palpate/run/bounding_box.h"
#include "palpate/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace palpate {
namespace {

// ---- obstacles ----

constexpr float infinite = std::numeric_limits<float>::infinity();

// Half the sides of an obstacle's bounding box, the smallest first.
vec3 half_sides(const Collider& collider) {
    const std::optional<Box> box = bounding_box(collider);
    if (!box) return vec3(infinite);
    vec3 half = box->half + box->rounding + collider.margin;
    std::sort(&half.x, &half.x + 3);
    return half;
}

// How deep a point lies in a shape, m; below zero outside. Polygons have no inside.
float depth(const Plane& plane, vec3 p) { return plane.offset - glm::dot(plane.normal, p); }
float depth(const Sphere& sphere, vec3 p) { return sphere.radius - glm::distance(p, sphere.centre); }
float depth(const Capsule& capsule, vec3 p) {
    const vec3 rod = capsule.to - capsule.from;
    const float square = glm::dot(rod, rod);
    const float part = square > 0 ? glm::clamp(glm::dot(p - capsule.from, rod) / square, 0.0f, 1.0f) : 0;
    return capsule.radius - glm::distance(p, capsule.from + part * rod);
}
float depth(const Box& box, vec3 p) {
    vec3 beyond;  // its faces
    for (int k = 0; k < 3; ++k)
        beyond[k] = std::abs(glm::dot(p - box.centre, box.axes[std::size_t(k)])) - box.half[k];
    const float most = std::max({beyond.x, beyond.y, beyond.z});
    return box.rounding - (most > 0 ? glm::length(glm::max(beyond, vec3(0))) : most);
}
float depth(const Polygon&, vec3) { return -infinite; }
float depth(const DistanceField& field, vec3 p) { return -field.at(p); }

// The greatest speed of any point of a collider, m/s.
float fastest(const Path& path, float reach) {
    float speed = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const float seconds = float(path[i].time - path[i - 1].time);
        const float way = glm::distance(path[i].position, path[i - 1].position);
        const float turned = glm::length(glm::radians(path[i].rotation - path[i - 1].rotation));
        speed = std::max(speed, (way + turned * reach) / seconds);
    }
    return speed;
}

// Tunnelling: a field looks eight times ahead on a node's way, three spacings at most (obstacles.inl).
// Spheres, capsules, boxes and polygons find what meets them however far it goes.
void look_at_fast_nodes(const Scene& scene, const Models& made, const Report& report,
                        std::vector<std::string>& notes) {
    for (std::size_t c = 0; c < made.simulation.colliders.size(); ++c) {
        const Collider& collider = made.simulation.colliders[c];
        const auto* field = std::get_if<DistanceField>(&collider.shape);
        if (!field) continue;
        const float ahead = 8 * 3 * field->spacing;
        const double own = fastest(scene.colliders[c].path, half_sides(collider).z);
        for (std::size_t m = 0; m < made.models.size(); ++m) {
            const Report::Body& body = report.bodies[m];
            const double way = (body.largest_speed + own) * body.step;
            if (!(way > ahead)) continue;
            notes.push_back(
                fmt::format("collider {}: nodes of body {} go up to {:.3g} m/s against it, {:.3g} m in a "
                            "step of {:.3g} s, and its field looks {:.3g} m ahead, so they may pass through "
                            "in one step; use shorter steps, or a polygon or a plane",
                            c + 1, body.name, body.largest_speed + own, way, body.step, ahead));
        }
    }
}

Pose pose_at_start(const Scene& scene, std::size_t collider) {
    const Path& path = scene.colliders[collider].path;
    return path.empty() ? Pose{} : pose(path, 0);
}

// The free nodes of a body at the start, in the frame in which a collider's shape is given.
std::vector<vec3> seen_from(const Scene& scene, const Models& made, std::size_t collider, std::size_t body) {
    const Pose at = pose_at_start(scene, collider);
    const dvec3 origin = dvec3(made.pivots[collider]) + at.place;
    const Body& nodes = made.models[body].body;
    std::vector<vec3> seen;
    for (std::size_t i = 0; i < nodes.count(); ++i)
        if (nodes.inverse_mass[i] > 0)
            seen.emplace_back(glm::conjugate(at.turn) * (dvec3(nodes.positions[i]) - origin));
    return seen;
}

// The directions in which nodes may come to a collider, in its frame: gravity's, and those of its own path.
std::vector<vec3> approaches(const Scene& scene, std::size_t collider) {
    std::vector<vec3> ways{scene.simulation.gravity};
    const Path& path = scene.colliders[collider].path;
    for (std::size_t i = 1; i < path.size(); ++i) ways.push_back(path[i - 1].position - path[i].position);
    const dquat back = glm::conjugate(pose_at_start(scene, collider).turn);
    for (vec3& way : ways) way = vec3(back * dvec3(way));
    std::erase_if(ways, [](vec3 way) { return !(glm::length(way) > 0); });
    return ways;
}

// A blade is a thin box that is met with its edge first, so that nodes which come along `way` may pass on
// both sides of it.
bool is_blade(const Box& box, vec3 way, std::span<const vec3> nodes) {
    constexpr float along = 0.5f;  // the cosine, of 60 degrees
    const vec3 half = box.half + box.rounding;
    const std::size_t thin = half.x <= std::min(half.y, half.z) ? 0 : half.y <= half.z ? 1 : 2;
    auto across = [&](vec3 v, std::size_t axis) { return glm::dot(v, box.axes[axis]); };
    std::size_t edge = (thin + 1) % 3, length = (thin + 2) % 3;
    if (std::abs(across(way, length)) > std::abs(across(way, edge))) std::swap(edge, length);
    if (std::abs(across(way, thin)) > along * glm::length(way)) return false;
    const float side = across(way, edge) < 0 ? 1 : -1;
    bool on_one = false, on_other = false;
    for (vec3 p : nodes) {
        p -= box.centre;
        if (side * across(p, edge) < half[int(edge)] || std::abs(across(p, length)) > half[int(length)])
            continue;
        on_one |= across(p, thin) > half[int(thin)];
        on_other |= across(p, thin) < -half[int(thin)];
    }
    return on_one && on_other;
}

// ---- what bodies do ----

bool is_moved(const Models& made, std::size_t body) {
    return std::ranges::any_of(made.moves, [&](const MovedNodes& moved) { return moved.body == body; });
}

bool is_held(const Scene& scene, const Models& made, std::size_t body) {
    const std::vector<float>& inverse = made.models[body].body.inverse_mass;
    return std::ranges::any_of(inverse, [](float one) { return !(one > 0); }) || !scene.colliders.empty() ||
           has_tool(scene, ToolKind::drag) || glm::length(scene.simulation.gravity) == 0;
}

dvec3 middle(std::span<const vec3> points) {
    dvec3 sum(0);
    for (vec3 p : points) sum += dvec3(p);
    return sum / double(std::max<std::size_t>(points.size(), 1));
}

// Bodies that ended far from where they began, though something should have held them.
void look_for_lost_bodies(const Scene& scene, const Models& made, const Play& play,
                          std::vector<std::string>& notes) {
    constexpr double far = 10;  // of its own size
    if (scene.colliders.empty() || glm::length(scene.simulation.gravity) == 0) return;
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const Body& body = made.models[m].body;
        if (!is_held(scene, made, m) || is_moved(made, m)) continue;
        const double size = glm::length(bounds(body.positions).size());
        const double way = glm::distance(middle(play.nodes(m).positions), middle(body.positions));
        if (way > far * size && size > 0)
            notes.push_back(
                fmt::format("body {}: it ended {:.3g} m from where it began, {:.0f} times its size; "
                            "did it pass what should hold it?",
                            body.name, way, way / size));
    }
}

void look_at_tools(const Scene& scene, const Report& report, std::vector<std::string>& notes) {
    for (std::size_t t = 0; t < scene.tools.size(); ++t) {
        const ToolRecipe& tool = scene.tools[t];
        const Report::Tool& did = report.tools[t];
        const bool went_all_its_way = !tool.path.empty() && report.simulated >= tool.path.back().time;
        if (tool.kind == ToolKind::drag || !went_all_its_way || did.largest_force > 0) continue;
        notes.push_back(
            fmt::format("tool {}: it touched nothing all along its path; change its path or its radius, "
                        "and check that both are in m",
                        tool.name));
    }
}

void look_at_steps(const Scene& scene, const Report& report, std::vector<std::string>& notes) {
    const double asked = scene.simulation.step;
    for (const Report::Body& body : report.bodies) {
        if (!(asked > 0) || body.steps == 0 || std::abs(body.step / asked - 1) < 1e-6) continue;
        const bool slices = has_tool(scene, ToolKind::touch);
        notes.push_back(
            fmt::format("steps were {:.6g} s and not {:.6g} s, so that whole ones fill {}", body.step, asked,
                        slices ? "the slices of about a millisecond in which a touch is felt"
                               : "a frame of 1/60 s; ask for a number of steps to have them exactly"));
        return;  // for all bodies alike
    }
}

}  // namespace

std::size_t held_at_start(const Scene& scene, const Models& made, std::size_t collider, std::size_t body) {
    constexpr float to_speak_of = 0.1f;  // of the spacing: less is pushed out without harm
    const Collider& one = made.simulation.colliders[collider];
    const float little = to_speak_of * made.models[body].body.spacing;
    return std::size_t(std::ranges::count_if(seen_from(scene, made, collider, body), [&](vec3 p) {
        return std::visit([&](const auto& shape) { return depth(shape, p); }, one.shape) + one.margin >
               little;
    }));
}

std::string how_to_ask_less(const Scene& scene, const Report& report) {
    for (const Report::Body& body : report.bodies)
        if (body.held_at_start > 0)
            return fmt::format(
                "move the colliders away from body {}: they hold {} of its {} nodes at the start", body.name,
                body.held_at_start, body.nodes);
    std::string less;
    auto add = [&](const char* what) { less += (less.empty() ? "" : " or ") + std::string(what); };
    bool presses = false, drags = false;
    for (std::size_t t = 0; t < scene.tools.size() && t < report.tools.size(); ++t) {
        const bool acts = report.tools[t].largest_force > 0;
        presses |= acts && presses_bodies(scene.tools[t].kind);
        drags |= acts && scene.tools[t].kind == ToolKind::drag;
    }
    if (presses) add("press less hard");
    if (drags) add("pull less hard");
    if (!scene.moves.empty()) add("move its nodes less far");
    const bool collides =
        std::ranges::any_of(scene.colliders, [](const ColliderRecipe& one) { return !one.path.empty(); });
    if (collides) add("push it less far");
    if (!less.empty()) return less;
    if (!scene.wind.empty()) return "use a stiffer material, or less wind";
    constexpr float strong = 50;  // m/s²
    const float gravity = glm::length(scene.simulation.gravity);
    if (gravity == 0) return "press or pull it less hard";
    if (gravity > strong)
        return fmt::format("use less gravity: it is {:.3g} times the Earth's", gravity / 9.81f);
    return "use a stiffer material: its own weight is too much for it";
}

namespace {

// Young's modulus of a solid, Pa; 0 of what else there is.
double modulus(const Scene& scene, const Models& made, std::size_t body) {
    if (const TissueCells* cells = tissue_of(made.models[body].body)) return cells->youngs_modulus;
    return body < scene.bodies.size() ? scene.bodies[body].material.youngs_modulus : 0;
}

std::vector<int> held_nodes(const Body& body) {
    std::vector<int> held;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (!(body.inverse_mass[i] > 0)) held.push_back(int(i));
    return held;
}

// A body whose own weight is too much for it.
void look_at_weight(const Scene& scene, const Models& made, std::size_t m, std::vector<std::string>& notes) {
    constexpr double much = 0.3, little = 0.1;                                  // strains
    if (m < scene.bodies.size() && scene.bodies[m].bears_its_weight()) return;  // build() has said it
    const Body& body = made.models[m].body;
    const double stiffness = modulus(scene, made, m),
                 stress = own_weight_stress(body, held_nodes(body), scene.simulation.gravity);
    if (stiffness > 0 && stress > much * stiffness)
        notes.push_back(
            fmt::format("body {}: its own weight strains it by {:.0f} %, so it sags, and falls over if it is "
                        "slender; give it "
                        "youngs_modulus = {:.2g} Pa for {:.0f} %, hold more of it, or turn gravity off",
                        body.name, 100 * stress / stiffness, stress / little, 100 * little));
}

constexpr float widest_gap = 0.7f;  // of the spacing: half the diagonal of a square of nodes

// How wide an obstacle is where nodes of a body may pass it on both sides, m; 0: nowhere.
float fine_side(const Scene& scene, const Models& made, std::size_t collider, std::size_t body) {
    const Collider& one = made.simulation.colliders[collider];
    const vec3 half = half_sides(one);
    const Body& nodes = made.models[body].body;
    if (nodes.count() < 2) return 0;
    if (half.y < widest_gap * nodes.spacing) return 2 * half.y;  // a ball or a rod
    const auto* box = std::get_if<Box>(&one.shape);
    if (!box || !(2 * half.x < nodes.spacing)) return 0;
    const std::vector<vec3> seen = seen_from(scene, made, collider, body);
    const bool cuts =
        std::ranges::any_of(approaches(scene, collider), [&](vec3 way) { return is_blade(*box, way, seen); });
    return cuts ? 2 * half.x : 0;
}

}  // namespace

std::vector<std::string> notes_before(const Scene& scene, const Models& made) {
    std::vector<std::string> notes = made.notes;
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const Body& body = made.models[m].body;
        if (!is_held(scene, made, m))
            notes.push_back(
                fmt::format("body {}: nothing holds it, so it falls; give it a pin, or the scene a collider, "
                            "or no gravity",
                            body.name));
        look_at_weight(scene, made, m, notes);
        for (const ToolRecipe& tool : scene.tools)
            if (presses_bodies(tool.kind) && tool.radius < widest_gap * body.spacing)
                notes.push_back(
                    fmt::format("tool {}: its tip is finer than the lattice of body {} and may fall "
                                "between the nodes; use more nodes",
                                tool.name, body.name));
        for (std::size_t c = 0; c < made.simulation.colliders.size(); ++c) {
            if (const std::size_t held = held_at_start(scene, made, c, m); held > 0)
                notes.push_back(
                    fmt::format("collider {} holds {} of {} nodes of body {} at the start; move one away",
                                c + 1, held, body.count(), body.name));
            if (const float across = fine_side(scene, made, c, m); across > 0)
                notes.push_back(
                    fmt::format("collider {}: it is {:.3g} m across, and the nodes of body {} are {:.3g} m "
                                "apart, so it may pass between them; make it larger, or use more nodes",
                                c + 1, across, body.name, body.spacing));
        }
    }
    return notes;
}

namespace {

// Whether it is a solid of springs that could be tissue.
bool could_be_tissue(const Scene& scene, const std::string& body) {
    return std::ranges::any_of(scene.bodies, [&](const BodyRecipe& recipe) {
        return recipe.name == body && recipe.material.youngs_modulus > 0 && !is_tissue(recipe.material);
    });
}

}  // namespace

std::vector<std::string> notes_after(const Scene& scene, const Models& made, const Report& report,
                                     const Play& play) {
    std::vector<std::string> notes;
    for (const Report::Body& body : report.bodies)
        if (body.inverted_cells > 0)
            notes.push_back(fmt::format(
                "body {}: up to {} of {} cells were inside out; {}, or use more nodes{}", body.name,
                body.inverted_cells, body.cells, how_to_ask_less(scene, report),
                could_be_tissue(scene, body.name)
                    ? ", or make it of tissue (model = \"tissue\" and no links): such cells turn back"
                    : ""));
    look_for_lost_bodies(scene, made, play, notes);
    look_at_tools(scene, report, notes);
    look_at_fast_nodes(scene, made, report, notes);
    look_at_steps(scene, report, notes);
    return notes;
}

}  // namespace palpate
