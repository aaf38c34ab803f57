#include "palpate/scene/check.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

namespace palpate {
namespace {

// Fails unless a condition holds, with the line of a key, or of the recipe if the key is empty or not given.
class Require {
 public:
    Require(std::string what_of, const Lines& lines, const SceneSource& source)
        : what_of_(std::move(what_of)), lines_(lines), source_(source) {}

    void operator()(const std::string& key, bool holds, const std::string& what,
                    const std::string& remedy) const {
        if (!holds) throw Error(what_of_ + ": " + what, lines_.where(key, source_.file), remedy);
    }
    bool has(const std::string& key) const { return lines_.has(key); }

    // Requires exactly one of several keys.
    void one_of(const std::vector<std::string>& keys, const std::string& remedy) const {
        std::string all, given, last;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            all += (i == 0 ? "" : i + 1 == keys.size() ? " and " : ", ") + keys[i];
            if (!has(keys[i])) continue;
            given += (given.empty() ? "" : " and ") + keys[i];
            last = keys[i];
        }
        (*this)(last, given == last && !given.empty(),
                fmt::format("it needs exactly one of {}, but has {}", all,
                            given.empty() ? "none" : "both " + given),
                given.empty() ? remedy : "remove one");
    }

 private:
    std::string what_of_;
    const Lines& lines_;
    const SceneSource& source_;
};

// `key`: the prefix of the choice's keys, such as "pin.".
void check(const Choice& choice, const std::string& key, const Require& require) {
    require(key + "radius", choice.near || choice.radius == 0, key + "radius without " + key + "near",
            "give the point");
    require(key + "box", choice.box.empty() || choice.box.size() == 2, key + "box is not two corners",
            "write [[…], […]]");
}

void check(const Region& region, const BodyRecipe& body, const SceneSource& source) {
    const Require require("body " + body.name + ", region", region.lines, source);
    check(region.choice, "", require);
    require("", !region.choice.empty() || !region.labels.empty(), "it does not say which nodes",
            "give it near and radius, a box, or labels");
    require("label", region.labels.empty() == !region.label, "labels and label go together",
            "give the file and the value");
    require.one_of({"youngs_modulus", "stiffness", "factor"}, "give it one");
    require("", region.factor > 0 || (!body.springs && !body.is_cloth()),
            "springs of several kinds have neither one modulus nor one stiffness", "give it a factor");
    require("stiffness", region.stiffness == 0 || !body.is_of_tissue(), "a stiffness in a body of tissue",
            "give it youngs_modulus or a factor");
}

// A named tissue is made of cells of a solid and has a modulus.
void check_tissue(const BodyRecipe& body, const Require& require) {
    require("tissue", !body.is_cloth(), "cloth of a tissue", "give it springs and a density in kg/m²");
    for (const char* key : {"stiffness", "springs", "bending"})
        require(key, !require.has(key), std::string(key) + " beside tissue",
                "remove one: a tissue has no springs");
    require("mass", !require.has("density") || !require.has("mass"), "both density and mass", "remove one");
}

// Springs and tissue do not go together.
void check_model(const BodyRecipe& body, const Require& require) {
    const bool of_tissue = body.material.model == MaterialModel::tissue;
    require("links", !of_tissue || !require.has("links"), "links of a body of tissue, which has no springs",
            require.has("poisson") ? "remove links or poisson" : "remove it, or write model = \"springs\"");
    require(require.has("poisson") ? "poisson" : "model", !of_tissue || !body.is_flat(),
            "tissue that is one node thick", "use 2 nodes or more along each axis, or make it of springs");
    require("poisson", of_tissue || !require.has("poisson"), "poisson of springs, which have 1/4",
            "remove it, or the model");
}

// The stiffness of springs: a modulus, one stiffness, or one for each kind.
void check_springs(const BodyRecipe& body, const Require& require) {
    if (body.springs || body.is_cloth()) {
        for (const char* key : {"youngs_modulus", "stiffness", "poisson", "model"})
            require(key, !require.has(key), "springs of several kinds beside " + std::string(key),
                    "remove it, and write springs = { structural = 100, shear = 50, flexion = 5 }");
        require("springs", body.is_cloth() || body.dims, "springs are for cloth, sheets and dims",
                "give youngs_modulus or stiffness");
        require("links", !require.has("links"), "links has no effect here", "remove it");
    } else if (!body.bears_its_weight() || body.material.model == MaterialModel::springs ||
               require.has("links")) {
        require.one_of({"youngs_modulus", "stiffness"},
                       "give it one: brain has about 1e4 Pa; or give the N/m of each spring");
    }
    require("stiffness", body.material.stiffness == 0 || body.material.model != MaterialModel::tissue,
            "tissue with a stiffness of springs", "give it youngs_modulus, in Pa");
    require("bending", body.sheet || !require.has("bending"),
            "bending of a body that is not a sheet of triangles",
            "give cloth flexion springs, or use sheet = true with a surface");
    if (body.springs)
        require("springs", body.springs->structural > 0, "springs without structural ones",
                "write springs = { structural = 100, shear = 50, flexion = 5 }");
}

// Grids: a box, a rectangle of cloth.
void check_grid(const BodyRecipe& body, const Require& require) {
    const std::string key = body.dims ? "dims" : "cloth";
    const ivec3 d = body.dims ? *body.dims : ivec3(*body.cloth, 1);
    require(key, double(d.x) * d.y * d.z <= 1e7, key + " is more than 10 million nodes", "use fewer");
    for (const char* one : {"iso", "units", "smooth", "size", "centre", "faces", "nodes", "weld", "specks",
                            "solid", "voxel", "largest"})
        require(one, !require.has(one), fmt::format("{} beside {}, where it has no effect", one, key),
                "remove it");
    require(key, body.spacing > 0, key + " without spacing", "give the distance of the nodes, in m");
}

// Textures. A map needs texture coordinates, which only files and cloth have.
void check_maps(const BodyRecipe& body, const Require& require) {
    require("weave", body.normal_map.empty() || !body.weave, "both normal_map and weave", "remove one");
    require("shade", !body.is_textured() || body.shade != Shade::pressure, "the pressure over a texture",
            "leave out shade, or colour_map, normal_map and weave");
    if (!body.is_textured()) return;
    const std::string map = require.has("colour_map")   ? "colour_map"
                            : require.has("normal_map") ? "normal_map"
                                                        : "weave";
    require(map, !body.surface.empty() || body.cloth, map + " on a body without texture coordinates",
            "use a surface that has them, or cloth");
    for (const char* key : {"faces", "smooth"})
        require(key, key == std::string("faces") ? body.faces == 0 : body.smooth.value_or(0) == 0,
                fmt::format("{} beside {}, which loses the texture coordinates", map, key),
                "remove one or the other");
}

void check(Friction friction, const std::string& table, const Require& require) {
    require(table + "sliding", friction.sliding <= friction.still,
            fmt::format("{0}sliding is above {0}friction, so nothing would ever stick", table),
            "make it no larger");
}

void check(const Feel& feel, const Require& require) { check(feel.friction, "touch.", require); }

// Common to all recipes of a surface.
void check_surface(const BodyRecipe& body, const Require& require) {
    require("iso", !body.volume.empty() || !body.iso, "iso without a volume", "remove it");
    require("size", body.size == 0 || body.size >= 1e-6f, "size is below 1e-6 m", "give it in m");
    require("size", body.size == 0 || !body.units, "both size and units", "remove one");
    check(body.feel, require);
}

void check_still(const BodyRecipe& surface, const SceneSource& source) {
    const Require require("surface " + surface.name, surface.lines, source);
    require.one_of({"volume", "surface"}, "name a file");
    check_surface(surface, require);
    require("shade", surface.shade != Shade::pressure, "the pressure on what nothing simulates",
            "make it a [[body]], or leave out shade");
}

void check(const BodyRecipe& body, const SceneSource& source) {
    const Require require("body " + body.name, body.lines, source);
    require.one_of({"volume", "surface", "dims", "cloth"}, "give it one");
    check_surface(body, require);
    require("",
            (!body.centre && body.size == 0) ||
                std::all_of(body.regions.begin(), body.regions.end(),
                            [](const Region& region) { return region.labels.empty(); }),
            "centre or size beside labels, which would stay as they are", "use move and units");
    require("sheet", !body.sheet || !body.surface.empty(), "sheet without a surface", "name its file");
    require("spacing", !body.sheet || body.spacing == 0, "sheet beside spacing: its nodes are its vertices",
            "remove spacing, or change the sheet by faces");
    require("nodes", !require.has("nodes") || !(body.sheet || body.cage || body.spacing > 0),
            fmt::format("nodes beside {}, which decides how many there are", body.sheet  ? "sheet"
                                                                             : body.cage ? "cage"
                                                                                         : "spacing"),
            "remove one");
    if (body.cage) {
        const ivec3 c = *body.cage;
        require("cage", !body.dims && !body.cloth && !body.sheet,
                "cage without a surface or a volume to go around", "name one, or use dims");
        require("cage", std::min(c.x, c.y) >= 2 && double(c.x) * c.y * c.z <= 1e7,
                "cage is not at least 2 along each axis (a last 1 is a sheet) and at most 10 million nodes",
                "change it");
    }
    check_model(body, require);
    if (require.has("tissue")) {
        check_tissue(body, require);
    } else {
        check_springs(body, require);
        require.one_of({"density", "mass"}, body.is_cloth() ? "give it one: a shirt has about 0.15 kg/m²"
                                                            : "give it one: water has 1000 kg/m³");
    }
    if (body.dims || body.cloth) check_grid(body, require);
    check_maps(body, require);
    check(body.pin, "pin.", require);
    for (const Region& region : body.regions) check(region, body, source);
}

// ---- colliders ----

void check_shape(Plane& plane, const Require& require) {
    require("plane.normal", glm::length(plane.normal) > 0, "a plane whose normal is zero",
            "give it a direction");
    plane.normal = glm::normalize(plane.normal);
}
void check_shape(const Sphere&, const Require&) {}
void check_shape(const Capsule&, const Require&) {}
void check_shape(const Box& box, const Require& require) {
    const float least = std::min({box.half.x, box.half.y, box.half.z});
    require("box", least + box.rounding > 0, "a box with a side that is not above zero", "give them in m");
}
void check_shape(const Polygon& polygon, const Require& require) {
    for (const auto& [a, b, c] : polygon.triangles)
        require("polygon.triangles", glm::length(glm::cross(b - a, c - a)) > 0,
                "a polygon with a degenerate triangle", "give it three corners that are not collinear");
}
void check_shape(const DistanceField&, const Require&) {}

void check(ColliderRecipe& recipe, std::size_t number, const SceneSource& source) {
    const Require require(fmt::format("collider {}", number), recipe.lines, source);
    std::visit([&](auto& shape) { check_shape(shape, require); }, recipe.collider.shape);
    require("about", !recipe.about || !recipe.path.empty(), "about without a path", "remove it");
}

// ---- moves and tools ----

std::string all_of(const std::set<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

void check(MoveRecipe& move, std::size_t number, const std::set<std::string>& bodies,
           const SceneSource& source) {
    const Require require(fmt::format("move {}", number), move.lines, source);
    if (move.body.empty() && bodies.size() == 1) move.body = *bodies.begin();
    require("", !move.body.empty(), "it does not say which body", "name one of " + all_of(bodies));
    require("body", bodies.contains(move.body), "no body \"" + move.body + "\"",
            "name one of " + all_of(bodies));
    check(move.nodes, "nodes.", require);
    require("nodes", !move.nodes.empty(), "it does not say which nodes", "write nodes = { below = 0.1 }");
    require("path", !move.path.empty(), "no path", "give it a file or rows of [t, x, y, z]");
}

void check(const ToolRecipe& tool, const std::set<std::string>& bodies, const SceneSource& source) {
    const Require require("tool " + tool.name, tool.lines, source);
    require("device", feels(tool.kind) || tool.device == ToolRecipe{}.device,
            fmt::format("a {} does not use a device", name_of(tool.kind)),
            fmt::format("leave out \"{}\", or make it a touch", tool.device));
    require("path", !tool.path.empty(), "no path", "give it a file or rows of [t, x, y, z]");
    require("pad", !tool.pad || glm::length(glm::cross(tool.pad->width, tool.pad->height)) > 0,
            "a pad whose sides are parallel or zero",
            "give it width = [0.02, 0, 0] and height = [0, 0, 0.02], in m");
    require("along", (!tool.from && tool.shaft == 0) || glm::length(tool.along) > 0, "along is zero",
            "give it a direction");
    require("along", tool.from || tool.shaft > 0 || !require.has("along"), "along without from or shaft",
            "give the point from which the tip comes");
    require("body", tool.body.empty() || bodies.contains(tool.body), "no body \"" + tool.body + "\"",
            "name one of " + all_of(bodies));
    check(tool.friction, "", require);
    require("relative", !tool.relative || tool.near, "relative without near",
            "give the point near which it grasps a node");
    require("kind", tool.kind != ToolKind::drag || !bodies.empty(), "no body that could be dragged",
            "add a [[body]]");
}

void check(const CameraRecipe& camera, const std::set<std::string>& names, const SceneSource& source) {
    const std::string where = camera.lines.where("look_at", source.file);
    if (const auto* at = std::get_if<std::string>(&camera.look_at); at && !names.contains(*at))
        throw Error("camera.look_at names no body or surface: " + *at, where,
                    "name one of them, or give a point");
    if (const auto* at = std::get_if<vec3>(&camera.look_at); at && camera.eye == *at)
        throw Error("camera.look_at is the same point as camera.eye", where, "look at another point");
}

// ---- all of it ----

// Names become parts of file names and cells of tables, so some characters are not allowed.
void check_name(const std::string& name, const Lines& lines, const SceneSource& source) {
    for (unsigned char c : name)
        if (c < ' ' || std::string_view("/\\,\"").find(char(c)) != std::string_view::npos)
            throw Error("a name with a slash, a comma, a quote or an unprintable character",
                        lines.where("name", source.file), "choose another");
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
        check_name(one.name, one.lines, source);
        if (!names.insert(one.name).second)
            throw Error("a second body or surface named " + one.name, one.lines.where("name", source.file),
                        "give each its own name");
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
        check_name(scene.tools[i].name, scene.tools[i].lines, source);
        check(scene.tools[i], bodies, source);
    }
    if (scene.colliders.size() > 16)
        source.fail(scene.colliders[16].lines.table, "more than 16 colliders", "use fewer");
    check(scene.camera, names, source);
}

}  // namespace palpate
