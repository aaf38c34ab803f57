#include "palpate/base/files.h"
#include "palpate/body/influences.h"
#include "palpate/scene/check.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

namespace palpate {
namespace {

// ---- what a scene file may hold ----

// A path is the name of a file, or rows of numbers.
void read_path_value(Reader& read, Path& path, Rows kind, const SceneSource& source,
                     const std::filesystem::path& folder) {
    const toml::node* node = read.get("path");
    if (!node) return;
    if (const auto file = node->value_exact<std::string>()) {
        path = read_path(find_data(*file, folder), kind);
        return;
    }
    std::vector<std::vector<double>> rows;
    read.read("path", *node, rows);
    if (rows.empty()) source.fail(line_of(*node), "a path without a row", "write [[t, x, y, z], …]");
    path = make_path(rows, kind, [&](std::size_t row, const std::string& what, const std::string& remedy) {
        source.fail(line_of(*node), fmt::format("row {} of a path {}", row + 1, what), remedy);
    });
}

void read_fields(Reader& read, Choice& choice) {
    read("below", choice.below);
    read("nodes", choice.nodes);
    read("near", choice.near);
    read("radius", choice.radius);
    read("box", choice.box);
}

void read_fields(Reader& read, Region& region) {
    read_fields(read, region.choice);
    read("labels", region.labels);
    read("label", region.label);
    read("youngs_modulus", region.youngs_modulus);
    read("stiffness", region.stiffness);
    read("factor", region.factor);
}

void read_fields(Reader& read, SpringKinds& springs) {
    read("structural", springs.structural);
    read("shear", springs.shear);
    read("flexion", springs.flexion);
}

// The name of a file, or several: the first that is found.
void read_files(Reader& read, const char* key, std::string& first, std::vector<std::string>& others) {
    const toml::node* node = read.get(key);
    if (!node) return;
    if (!node->is_array()) {
        read.read(key, *node, first);
        return;
    }
    read.read(key, *node, others);
    if (others.empty()) read.wrong(key, *node, "a file, or a list of files");
    first = others.front();
    others.erase(others.begin());
}

void read_fields(Reader& read, Feel& feel) {
    read("stiffness", feel.stiffness);
    read("damping", feel.damping);
    read("friction", feel.friction.still);
    feel.friction.sliding = std::min(feel.friction.sliding, feel.friction.still);
    read("sliding", feel.friction.sliding);
    read("width", feel.dent_width);
    read("yield", feel.yield);
}

// What makes a surface, how it looks and how it feels.
void read_surface(Reader& read, BodyRecipe& body) {
    read("name", body.name);
    read("volume", body.volume);
    read_files(read, "surface", body.surface, body.stand_ins);
    read("iso", body.iso);
    read("units", body.units);
    read("rotate", body.rotate);
    read("size", body.size);
    read("centre", body.centre);
    read("move", body.move);
    read("largest", body.largest);
    read("weld", body.repair.weld);
    read("specks", body.repair.specks);
    read("solid", body.repair.solid);
    read("voxel", body.repair.voxel);
    read("smooth", body.smooth);
    read("faces", body.faces);
    read("colour", body.colour);
    read("shine", body.shine);
    read("shade", body.shade);
    read.table("touch", [&](Reader& inside) { read_fields(inside, body.feel); });
}

void read_fields(Reader& read, BodyRecipe& body) {
    read_surface(read, body);
    read("dims", body.dims);
    read("cloth", body.cloth);
    read("sheet", body.sheet);
    read("nodes", body.nodes);
    read("spacing", body.spacing);
    read("cage", body.cage);
    read("youngs_modulus", body.material.youngs_modulus);
    read("stiffness", body.material.stiffness);
    read.table("springs", [&](Reader& inside) { read_fields(inside, body.springs.emplace()); });
    read("density", body.material.density);
    read("mass", body.material.mass);
    read("damping", body.material.damping);
    read("link_damping", body.material.link_damping);
    read("links", body.material.links);
    read("mapping", body.mapping);
    read("colour_map", body.colour_map);
    if (!body.colour_map.empty() && !read.has("colour")) body.colour = vec3(1);
    read("normal_map", body.normal_map);
    read("weave", body.weave);
    read.table("pin", [&](Reader& inside) { read_fields(inside, body.pin); });
    read.each("region", [&](Reader& inside, int line) {
        Region& region = body.regions.emplace_back();
        region.line = line;
        read_fields(inside, region);
    });
}

// ---- colliders ----

void read_shape(Reader& read, Plane& plane) {
    read("normal", plane.normal);
    read("offset", plane.offset);
}

void read_shape(Reader& read, Sphere& sphere) {
    read("centre", sphere.centre);
    read("radius", sphere.radius);
}

void read_shape(Reader& read, Capsule& capsule) {
    read("from", capsule.from);
    read("to", capsule.to);
    read("radius", capsule.radius);
}

void read_shape(Reader& read, Box& box, const SceneSource& source) {
    vec3 size(0), rotate(0);
    read("centre", box.centre);
    read("half", box.half);
    read("size", size);
    read("rotate", rotate);
    read("rounding", box.rounding);
    if (read.has("half") == read.has("size"))
        source.fail(read.line(), "a box wants half or size", "give it one of them");
    if (read.has("size")) box.half = 0.5f * size;
    const mat3 axes = turn(rotate);
    box.axes = {axes[0], axes[1], axes[2]};
}

// Where the triangles of a polygon or a field come from.
void read_file(Reader& read, ColliderRecipe& recipe) {
    read("surface", recipe.surface);
    read("units", recipe.units);
    read("rotate", recipe.rotate);
    read("move", recipe.move);
}

void read_shape(Reader& read, Polygon& polygon, ColliderRecipe& recipe, const SceneSource& source) {
    std::vector<std::vector<vec3>> triangles;
    read_file(read, recipe);
    read("triangles", triangles);
    read("thickness", polygon.thickness);
    if (read.has("surface") == read.has("triangles"))
        source.fail(read.line(), "a polygon wants a surface or triangles", "give it one of them");
    if (read.has("triangles") && (read.has("units") || read.has("rotate") || read.has("move")))
        source.fail(read.line(), "a polygon's units, rotate and move are for a surface", "remove them");
    if (read.has("triangles") && triangles.empty())
        source.fail(read.line(), "a polygon without a triangle", "write [[[…], […], […]], …]");
    for (const auto& corners : triangles) {
        if (corners.size() != 3)
            source.fail(read.line(), "a triangle without three corners", "write [[[…], […], […]], …]");
        polygon.triangles.push_back({corners[0], corners[1], corners[2]});
    }
}

void read_shape(Reader& read, DistanceField& field, ColliderRecipe& recipe, const SceneSource& source) {
    read_file(read, recipe);
    read("spacing", field.spacing);
    if (recipe.surface.empty()) source.fail(read.line(), "a field without a surface", "name a closed mesh");
}

void read_fields(Reader& read, ColliderRecipe& recipe, const SceneSource& source,
                 const std::filesystem::path& folder) {
    int shapes = 0;
    auto shape = [&](const char* key, auto one, auto... more) {
        read.table(key, [&](Reader& inside) {
            ++shapes;
            read_shape(inside, one, more.get()...);
            recipe.collider.shape = one;
        });
    };
    shape("plane", Plane{});
    shape("sphere", Sphere{});
    shape("capsule", Capsule{});
    shape("box", Box{}, std::cref(source));
    shape("polygon", Polygon{}, std::ref(recipe), std::cref(source));
    shape("field", DistanceField{}, std::ref(recipe), std::cref(source));
    read("friction", recipe.collider.friction);
    read("margin", recipe.collider.margin);
    read("colour", recipe.colour);
    read_path_value(read, recipe.path, Rows::poses, source, folder);
    read("about", recipe.about);
    read.finish();  // a misspelt shape is named as such
    if (shapes > 1) source.fail(recipe.line, "a collider with two shapes", "write one [[collider]] for each");
    if (shapes == 0)
        source.fail(recipe.line, "a collider without a shape",
                    "give it a plane, sphere, capsule, box, polygon or field");
}

// ---- what moves ----

void read_fields(Reader& read, MoveRecipe& move, const SceneSource& source,
                 const std::filesystem::path& folder) {
    read("body", move.body);
    read.table("nodes", [&](Reader& inside) { read_fields(inside, move.nodes); });
    read_path_value(read, move.path, Rows::poses, source, folder);
    read("about", move.about);
}

void read_fields(Reader& read, ToolRecipe& tool, const SceneSource& source,
                 const std::filesystem::path& folder) {
    read("name", tool.name);
    read("kind", tool.kind);
    if (tool.kind == ToolKind::drag) tool.stiffness = Drag{}.stiffness;
    read("device", tool.device);
    read("radius", tool.radius);
    read("stiffness", tool.stiffness);
    read("from", tool.from);
    read("along", tool.along);
    read("shaft", tool.shaft);
    read("body", tool.body);
    read("near", tool.near);
    read("relative", tool.relative);
    read("colour", tool.colour);
    read_path_value(read, tool.path, Rows::places, source, folder);
    auto refuse = [&](std::initializer_list<const char*> keys, const std::string& remedy) {
        for (const char* key : keys)
            if (read.has(key))
                source.fail(tool.line, fmt::format("\"{}\" means nothing to a {}", key, name_of(tool.kind)),
                            remedy);
    };
    if (tool.kind == ToolKind::drag)
        refuse({"from", "along", "shaft"}, "remove it");
    else
        refuse({"body", "near", "relative"}, "remove it, or write kind = \"drag\"");
    if (tool.kind == ToolKind::dent)
        refuse({"stiffness"}, "say it of the surfaces: touch = { stiffness = 400 }");
}

// Wind brings air with it.
void read_wind(Reader& read, Scene& scene, const SceneSource& source) {
    std::optional<vec3> velocity;
    read("velocity", velocity);
    read_path_value(read, scene.wind, Rows::places, source, scene.folder);
    if (velocity.has_value() == read.has("path"))
        source.fail(read.line(), "wind wants a velocity or a path", "give it one of them");
    if (velocity) scene.wind = {{0, *velocity}};
    read("density", scene.simulation.air);
}

// "auto" or seconds.
void read_step(Reader& read, double& step) {
    const toml::node* node = read.get("step");
    if (!node || node->value_exact<std::string>() == "auto") return;
    if (!node->is_number()) read.wrong("step", *node, "\"auto\" or a number of seconds");
    read.read("step", *node, step);
    if (!(step > 0)) read.wrong("step", *node, "\"auto\" or a number of seconds above zero");
}

// A point, or the name of a body.
void read_look_at(Reader& read, std::variant<vec3, std::string>& look_at) {
    const toml::node* node = read.get("look_at");
    if (!node) return;
    if (const auto name = node->value_exact<std::string>()) {
        look_at = *name;
    } else {
        read.read("look_at", *node, look_at.emplace<vec3>());
    }
}

void read_fields(Reader& read, Scene& scene, const SceneSource& source) {
    constexpr float usual_air = 1.2f;  // kg/m³
    std::optional<float> air;
    read.table("simulation", [&](Reader& inside) {
        inside("backend", scene.simulation.backend);
        inside("threads", scene.simulation.threads);
        inside("integrator", scene.simulation.integrator);
        read_step(inside, scene.simulation.step);
        inside("gravity", scene.simulation.gravity);
        inside("duration", scene.duration);
        inside("air", air);
    });
    read.table("wind", [&](Reader& inside) {
        if (air && inside.has("density"))
            source.fail(inside.line(), "the air's density is said twice", "remove simulation.air");
        scene.simulation.air = usual_air;
        read_wind(inside, scene, source);
    });
    if (air) scene.simulation.air = *air;
    read.table("camera", [&](Reader& inside) {
        inside("eye", scene.camera.eye);
        inside("up", scene.camera.up);
        inside("angle", scene.camera.angle);
        read_look_at(inside, scene.look_at);
        std::string projection = scene.camera.orthographic ? "orthographic" : "perspective";
        inside("projection", projection);
        if (projection != "orthographic" && projection != "perspective")
            source.fail(0, "\"" + projection + "\" is no projection", "choose perspective or orthographic");
        scene.camera.orthographic = projection == "orthographic";
    });
    read.table("light", [&](Reader& inside) {
        inside("direction", scene.light.direction);
        inside("colour", scene.light.colour);
    });
    read.each("body", [&](Reader& inside, int line) {
        BodyRecipe& body = scene.bodies.emplace_back();
        body.line = line;
        read_fields(inside, body);
    });
    read.each("surface", [&](Reader& inside, int line) {
        BodyRecipe& surface = scene.surfaces.emplace_back();
        surface.line = line;
        read_surface(inside, surface);
    });
    read.each("collider", [&](Reader& inside, int line) {
        ColliderRecipe& collider = scene.colliders.emplace_back();
        collider.line = line;
        read_fields(inside, collider, source, scene.folder);
    });
    read.each("move", [&](Reader& inside, int line) {
        MoveRecipe& move = scene.moves.emplace_back();
        move.line = line;
        read_fields(inside, move, source, scene.folder);
    });
    read.each("tool", [&](Reader& inside, int line) {
        ToolRecipe& tool = scene.tools.emplace_back();
        tool.line = line;
        read_fields(inside, tool, source, scene.folder);
    });
    read.finish();
}

// ---- changes from the command line ----

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> words(1);
    for (char c : text)
        if (c == at)
            words.emplace_back();
        else
            words.back() += c;
    return words;
}

// Among tables, the one with this name, or with this number from 1.
toml::table* find_named(toml::array& tables, const std::string& name) {
    for (std::size_t i = 0; i < tables.size(); ++i)
        if (toml::table* table = tables[i].as_table())
            if (table->get_as<std::string>("name") && table->get_as<std::string>("name")->get() == name)
                return table;
    for (std::size_t i = 0; i < tables.size(); ++i)
        if (std::to_string(i + 1) == name) return tables[i].as_table();
    return nullptr;
}

// The value after the equals sign, read as TOML where it is TOML, as a text where it is not.
toml::table parse_value(const std::string& key, const std::string& value) {
    try {
        return toml::parse("\"" + key + "\" = " + value);
    } catch (const toml::parse_error&) {
        return toml::table{{key, value}};
    }
}

// Where a change goes: "body.brain.nodes" as three words.
std::vector<std::string> target(const Change& change) {
    return split(change.substr(0, change.find('=')), '.');
}

// Whether it names what a body is made from.
bool names_source(const Change& change) {
    const std::vector<std::string> words = target(change);
    constexpr std::string_view sources[] = {"volume", "surface", "dims", "cloth"};
    return words.size() == 3 && (words[0] == "body" || words[0] == "surface") &&
           std::ranges::count(sources, words[2]) > 0;
}

// "collider.3={…}" where there are two: a third.
void add_one(toml::array& tables, const std::string& key, const Change& change, const SceneSource& source) {
    const toml::table value = parse_value(key, change.substr(change.find('=') + 1));
    const toml::table* one = value.get_as<toml::table>(key);
    if (key != std::to_string(tables.size() + 1) || !one)
        source.fail(
            0, "no such one",
            fmt::format("name a key of one of them, or write {}={{ … }} to add one", tables.size() + 1));
    tables.push_back(*one);
}

void apply(toml::table& root, const Change& change) {
    const SceneSource source{"--set " + change};
    const auto equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
        source.fail(0, "no value", "write --set body.brain.nodes=5000");
    std::vector<std::string> words = target(change);
    const std::string key = words.back();
    words.pop_back();

    toml::table* table = &root;
    for (std::size_t i = 0; i < words.size(); ++i) {
        toml::node* node = table->get(words[i]);
        if (toml::array* tables = node ? node->as_array() : nullptr) {
            if (i + 1 == words.size()) return add_one(*tables, key, change, source);
            table = find_named(*tables, words[++i]);
            if (!table)
                source.fail(0, "no " + words[i - 1] + " named " + words[i], "use a name from the scene");
        } else {
            if (!node && key == "1" && i + 1 == words.size()) {
                toml::array& first = *table->insert(words[i], toml::array{}).first->second.as_array();
                return add_one(first, key, change, source);
            }
            if (!node) node = &table->insert(words[i], toml::table{}).first->second;
            table = node->as_table();
            if (!table) source.fail(0, "\"" + words[i] + "\" is not a table", "name a key of the scene");
        }
    }
    toml::table value = parse_value(key, change.substr(equals + 1));
    if (!value.contains(key)) source.fail(0, "no value", "write one after the equals sign");
    if (names_source(change))
        for (const char* old :
             {"volume", "surface", "dims", "cloth", "iso", "units", "colour_map", "normal_map", "weave"})
            table->erase(old);
    table->insert_or_assign(key, *value.get(key));
}

}  // namespace

namespace {

toml::table changed_table(const std::string& text, const SceneSource& source,
                          std::span<const Change> changes) {
    toml::table root;
    try {
        root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        source.fail(int(error.source().begin.line), std::string(error.description()),
                    "correct the TOML there");
    }
    // Another source first: it takes away what was said of the old one.
    std::vector<Change> ordered(changes.begin(), changes.end());
    std::stable_partition(ordered.begin(), ordered.end(), names_source);
    for (const Change& change : ordered) apply(root, change);
    return root;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  std::span<const Change> changes) {
    const SceneSource source{name};
    toml::table root = changed_table(text, source, changes);
    Scene scene;
    scene.name = std::filesystem::path(name).stem().string();
    scene.folder = folder;
    Reader reader(root, source, "a scene");
    read_fields(reader, scene, source);
    check(scene, source);
    return scene;
}

std::string changed(const SceneText& scene, std::span<const Change> changes) {
    std::ostringstream text;
    text << changed_table(scene.text, SceneSource{scene.name}, changes) << '\n';
    return text.str();
}

SceneText find_scene(const std::string& file_or_name) {
    for (const ShippedScene& shipped : shipped_scenes())
        if (shipped.name == file_or_name)
            return {shipped.text, shipped.name, std::filesystem::current_path()};
    if (std::error_code error; !std::filesystem::exists(file_or_name, error)) {
        std::string list;
        for (const ShippedScene& shipped : shipped_scenes())
            list += (list.empty() ? "" : ", ") + shipped.name;
        throw Error("no such scene", file_or_name, "give a TOML file, or one of: " + list);
    }
    return {read_text(file_or_name), file_or_name, std::filesystem::path(file_or_name).parent_path()};
}

Scene read_scene(const std::string& file_or_name, std::span<const Change> changes) {
    return parse_scene(find_scene(file_or_name), changes);
}

}  // namespace palpate
