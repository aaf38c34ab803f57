#include "palpate/scene/check.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>

namespace palpate {
namespace {

// Fails unless something holds.
using Require = std::function<void(bool holds, const std::string& what, const std::string& remedy)>;

Require require_of(const std::string& what_of, int line, const SceneSource& source) {
    return [=](bool holds, const std::string& what, const std::string& remedy) {
        if (!holds) source.fail(line, what_of + ": " + what, remedy);
    };
}

// `key`: what the choice stands under, such as "pin.".
void check(const Choice& choice, const std::string& key, const Require& require) {
    require(choice.near || choice.radius == 0, key + "radius without " + key + "near",
            "say around which point");
    require(choice.radius >= 0, key + "radius is negative", "use a positive one");
    require(choice.box.empty() || choice.box.size() == 2, key + "box is not two corners", "write [[…], […]]");
    require(!choice.below || (*choice.below >= 0 && *choice.below <= 1), key + "below is not from 0 to 1",
            "0.15 is the lowest 15 %");
}

void check(const Region& region, const BodyRecipe& body, const SceneSource& source) {
    const Require require = require_of("body " + body.name + ", region", region.line, source);
    check(region.choice, "", require);
    require(!region.choice.empty() || !region.labels.empty(), "it says nowhere which nodes",
            "give it near and radius, a box, or labels");
    require(region.labels.empty() == !region.label, "labels and label go together",
            "give the file and the value");
    require((region.youngs_modulus > 0) + (region.stiffness > 0) + (region.factor > 0) == 1 &&
                std::min({region.youngs_modulus, region.stiffness, region.factor}) >= 0,
            "wants exactly one of youngs_modulus, stiffness and factor, above zero", "give it one");
    require(region.factor > 0 || (!body.springs && !body.is_cloth()),
            "springs of several kinds have neither one modulus nor one stiffness", "give it a factor");
}

// What the springs are made of: a modulus, one stiffness, or one for each kind.
void check_springs(const BodyRecipe& body, const Require& require) {
    const Material& m = body.material;
    const bool uniform = m.youngs_modulus > 0 || m.stiffness > 0;
    if (body.springs || body.is_cloth()) {
        require(!uniform, "springs of several kinds beside youngs_modulus or stiffness",
                "write springs = { structural = 100, shear = 50, flexion = 5 }");
        require(body.is_cloth() || body.dims, "springs are for cloth, sheets and dims",
                "give youngs_modulus or stiffness");
        require(m.links == Links::automatic, "links means nothing here", "remove it");
    } else {
        require((m.youngs_modulus > 0) != (m.stiffness > 0),
                "wants youngs_modulus or stiffness, one of them above zero", "give it one");
    }
    if (!body.springs) return;
    const SpringKinds& s = *body.springs;
    require(s.structural > 0 && std::min(s.shear, s.flexion) >= 0,
            "springs.structural is not above zero, or another is negative", "give them in N/m");
}

// Grids: a box, a rectangle of cloth.
void check_grid(const BodyRecipe& body, const Require& require) {
    const std::string key = body.dims ? "dims" : "cloth";
    const ivec3 d = body.dims ? *body.dims : ivec3(*body.cloth, 1);
    require(std::min({d.x, d.y, d.z}) >= 1 && double(d.x) * d.y * d.z <= 1e7,
            key + " is not at least 1 along each axis and at most 10 million nodes", "change it");
    require(body.spacing > 0, key + " without spacing", "say how far apart the nodes are, in m");
    require(!body.iso && !body.units && !body.smooth && body.size == 0 && !body.centre && body.faces == 0,
            key + " beside iso, units, smooth, size, centre or faces, which mean nothing there",
            "remove them");
}

// What it wears. A map needs texture coordinates, which only files and cloth have.
void check_maps(const BodyRecipe& body, const Require& require) {
    require(body.normal_map.empty() || !body.weave, "normal_map beside weave, of which one must count",
            "remove one");
    require(!body.weave || (std::min(body.weave->x, body.weave->y) >= 1 &&
                            std::max(body.weave->x, body.weave->y) <= 128),
            "weave is not from 1 to 128 threads each way", "write weave = [60, 40]");
    if (!body.is_textured()) return;
    require(!body.surface.empty() || body.cloth,
            "colour_map, normal_map or weave on what has no texture coordinates",
            "use a surface that has them, or cloth");
    require(body.faces == 0 && body.smooth.value_or(0) == 0,
            "colour_map, normal_map or weave beside faces or smooth, which lose the texture coordinates",
            "remove one or the other");
}

void check(const Feel& feel, const Require& require) {
    require(feel.stiffness > 0 && feel.dent_width > 0, "touch.stiffness or touch.width is not above zero",
            "give them in N/m and m");
    require(std::min({feel.damping, feel.friction.still, feel.friction.sliding, feel.yield}) >= 0,
            "touch.damping, friction, sliding or yield is negative", "use 0 or more");
    require(feel.friction.sliding <= feel.friction.still,
            "touch.sliding is above touch.friction, so nothing would ever stick", "make it no larger");
}

// What every recipe of a surface says.
void check_surface(const BodyRecipe& body, const Require& require) {
    require(!body.volume.empty() || !body.iso, "iso without a volume", "remove it");
    require(body.size == 0 || !body.units, "size beside units, of which one must count", "remove one");
    require(std::min(body.size, body.shine) >= 0, "a negative number where none makes sense",
            "use a positive one");
    require(body.faces >= 0 && body.smooth.value_or(0) >= 0 && body.smooth.value_or(0) <= 1000,
            "faces or smooth is out of range", "use 0 or more, and at most 1000 passes");
    const RepairSettings& repair = body.repair;
    require(std::min({repair.weld, repair.specks, repair.voxel}) >= 0 && repair.specks < 1,
            "weld, specks or voxel is out of range", "give lengths in m, and specks from 0 to below 1");
    check(body.feel, require);
}

void check_still(const BodyRecipe& surface, const SceneSource& source) {
    const Require require = require_of("surface " + surface.name, surface.line, source);
    require(surface.volume.empty() != surface.surface.empty(), "wants a volume or a surface", "name a file");
    check_surface(surface, require);
}

void check(const BodyRecipe& body, const SceneSource& source) {
    const Require require = require_of("body " + body.name, body.line, source);
    const Material& m = body.material;
    const int sources =
        !body.volume.empty() + !body.surface.empty() + body.dims.has_value() + body.cloth.has_value();
    require(sources == 1, "wants exactly one of volume, surface, dims and cloth", "give it one");
    check_surface(body, require);
    require((!body.centre && body.size == 0) ||
                std::all_of(body.regions.begin(), body.regions.end(),
                            [](const Region& region) { return region.labels.empty(); }),
            "centre or size beside labels, which would stay as they are", "use move and units");
    require(!body.sheet || !body.surface.empty(), "sheet without a surface", "name its file");
    require(!body.sheet || body.spacing == 0, "sheet beside spacing: its nodes are its vertices",
            "remove spacing, or change the sheet by faces");
    if (body.cage) {
        const ivec3 c = *body.cage;
        require(!body.surface.empty() + !body.volume.empty() == 1 && !body.sheet,
                "cage without a surface or a volume to go around", "name one, or use dims");
        require(std::min(c.x, c.y) >= 2 && c.z >= 1 && double(c.x) * c.y * c.z <= 1e7,
                "cage is not at least 2 along each axis (a last 1 is a sheet) and at most 10 million nodes",
                "change it");
    }
    check_springs(body, require);
    require((m.density > 0) != (m.mass > 0), "wants density or mass, one of them above zero", "give it one");
    require(std::min({m.youngs_modulus, m.stiffness, m.density, m.mass, m.damping, m.link_damping,
                      body.spacing}) >= 0,
            "a negative number where none makes sense", "use a positive one");
    require(body.nodes > 0 && body.nodes <= 10'000'000, "nodes is not from 1 to 10 million",
            "choose a number there");
    if (body.dims || body.cloth) check_grid(body, require);
    check_maps(body, require);
    check(body.pin, "pin.", require);
    for (const Region& region : body.regions) check(region, body, source);
}

// ---- colliders ----

void check_shape(Plane& plane, const Require& require) {
    require(glm::length(plane.normal) > 0, "a plane whose normal is zero", "give it a direction");
    plane.normal = glm::normalize(plane.normal);
}
void check_shape(const Sphere& sphere, const Require& require) {
    require(sphere.radius > 0, "a sphere whose radius is not above zero", "give it one in m");
}
void check_shape(const Capsule& capsule, const Require& require) {
    require(capsule.radius > 0, "a capsule whose radius is not above zero", "give it one in m");
}
void check_shape(const Box& box, const Require& require) {
    const float least = std::min({box.half.x, box.half.y, box.half.z});
    require(least >= 0 && box.rounding >= 0 && least + box.rounding > 0,
            "a box with a side that is not above zero, or a negative rounding", "give them in m");
}
void check_shape(const Polygon& polygon, const Require& require) {
    require(polygon.thickness > 0, "a polygon whose thickness is not above zero", "give it one in m");
    for (const auto& [a, b, c] : polygon.triangles)
        require(glm::length(glm::cross(b - a, c - a)) > 0, "a polygon with a triangle that has no area",
                "give it three corners that are not in a line");
}
void check_shape(const DistanceField& field, const Require& require) {
    require(field.spacing >= 0, "a field whose spacing is negative", "give it one in m, or none");
}

void check(ColliderRecipe& recipe, std::size_t number, const SceneSource& source) {
    const Require require = require_of(fmt::format("collider {}", number), recipe.line, source);
    std::visit([&](auto& shape) { check_shape(shape, require); }, recipe.collider.shape);
    require(std::min(recipe.collider.friction, recipe.collider.margin) >= 0, "friction or margin is negative",
            "use 0 or more");
    require(!recipe.about || !recipe.path.empty(), "about without a path", "remove it");
}

// ---- what moves ----

std::string all_of(const std::set<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

void check(MoveRecipe& move, std::size_t number, const std::set<std::string>& bodies,
           const SceneSource& source) {
    const Require require = require_of(fmt::format("move {}", number), move.line, source);
    if (move.body.empty() && bodies.size() == 1) move.body = *bodies.begin();
    require(!move.body.empty(), "it says nowhere which body", "name one of " + all_of(bodies));
    require(bodies.contains(move.body), "no body \"" + move.body + "\"", "name one of " + all_of(bodies));
    check(move.nodes, "nodes.", require);
    require(!move.nodes.empty(), "it says nowhere which nodes", "write nodes = { below = 0.1 }");
    require(!move.path.empty(), "no path", "give it a file or rows of [t, x, y, z]");
}

void check(const ToolRecipe& tool, const std::set<std::string>& bodies, const SceneSource& source) {
    const Require require = require_of("tool " + tool.name, tool.line, source);
    require(tool.device == "script" || (tool.device == "hand" && tool.kind == ToolKind::dent),
            fmt::format("no device \"{}\" for a {}", tool.device, name_of(tool.kind)),
            "the devices there are: script, and for a dent hand");
    require(tool.shaft >= 0, "shaft is negative", "give it in m");
    require(tool.radius > 0 && tool.stiffness > 0, "radius and stiffness must be above zero",
            "give both, in m and N/m");
    require(!tool.path.empty(), "no path", "give it a file or rows of [t, x, y, z]");
    require(!tool.from || glm::length(tool.along) > 0, "along is zero", "give it a direction");
    require(tool.body.empty() || bodies.contains(tool.body), "no body \"" + tool.body + "\"",
            "name one of " + all_of(bodies));
    require(!tool.relative || tool.near, "relative without near",
            "say near which point it takes hold of a node");
}

// ---- all of it ----

// Names become parts of file names and cells of tables.
void check_name(const std::string& name, int line, const SceneSource& source) {
    for (unsigned char c : name)
        if (c < ' ' || std::string_view("/\\,\"").find(char(c)) != std::string_view::npos)
            source.fail(line, "a name with a slash, a comma, a quote or an unprintable letter",
                        "choose another");
}

}  // namespace

void SceneSource::fail(int line, const std::string& what, const std::string& remedy) const {
    throw Error(what, line > 0 ? fmt::format("{}, line {}", file, line) : file, remedy);
}

void check(Scene& scene, const SceneSource& source) {
    if (scene.bodies.empty() && scene.surfaces.empty()) source.fail(0, "no body", "add a [[body]]");
    std::set<std::string> names;
    auto name = [&](BodyRecipe& one, const char* kind, std::size_t number) {
        if (one.name.empty()) one.name = fmt::format("{}{}", kind, number);
        check_name(one.name, one.line, source);
        if (!names.insert(one.name).second)
            source.fail(one.line, "a second body or surface named " + one.name, "give each its own name");
    };
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        name(scene.bodies[i], "body", i + 1);
        check(scene.bodies[i], source);
    }
    const std::set<std::string> bodies = names;
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        name(scene.surfaces[i], "surface", i + 1);
        check_still(scene.surfaces[i], source);
    }
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) check(scene.colliders[i], i + 1, source);
    for (std::size_t i = 0; i < scene.moves.size(); ++i) check(scene.moves[i], i + 1, bodies, source);
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
        if (scene.tools[i].name.empty()) scene.tools[i].name = fmt::format("tool{}", i + 1);
        check_name(scene.tools[i].name, scene.tools[i].line, source);
        check(scene.tools[i], bodies, source);
    }
    if (scene.tools.size() > 8) source.fail(0, "more than 8 tools", "use fewer");
    if (scene.colliders.size() > 16) source.fail(0, "more than 16 colliders", "use fewer");
    if (const auto* at = std::get_if<std::string>(&scene.look_at); at && !names.contains(*at))
        source.fail(0, "camera.look_at names no body or surface: " + *at,
                    "name one of them, or give a point");
    if (scene.simulation.threads < 1 || scene.simulation.threads > most_threads)
        source.fail(0, fmt::format("{} threads", scene.simulation.threads),
                    fmt::format("choose 1 to {}; no more than the machine has cores", most_threads));
    if (!(scene.simulation.air >= 0)) source.fail(0, "the air's density is negative", "1.2 is usual");
    if (!(scene.duration > 0 && scene.duration <= 1e6))
        source.fail(0, "duration is not above zero", "give it in seconds");
    if (!(scene.camera.angle > 0 && scene.camera.angle < 180))
        source.fail(0, "camera.angle is not between 0 and 180 degrees", "35 is usual");
}

}  // namespace palpate
