#include "palpate/body/influences.h"
#include "palpate/body/tissues.h"
#include "palpate/scene/check.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>
#include <sstream>

namespace palpate {
namespace {

// ---- the keys of a scene file ----

// Lengths of bodies; and coordinates, also of paths.
const NumberRange length = between(1e-6, 1e4, "m");
const NumberRange position = between(-1e6, 1e6, "m");

// A path is the name of a file, or rows of numbers.
void read_path_value(Reader& read, Path& path, Rows kind, Scene& scene) {
    const toml::node* node = read.get("path");
    if (!node) return;
    if (const auto file = node->value_exact<std::string>()) {
        if (!is_found(*file, scene.folder))
            read.fail(*node, "cannot find the file " + *file, remedy_for_missing(*file, scene.folder));
        scene.path_files.push_back(find_data(*file, scene.folder));
        try {
            path = read_path(scene.path_files.back(), kind);
        } catch (const Error& error) {
            throw Error(fmt::format("{}, path: {}", read.where(*node), error.what()));
        }
        return;
    }
    std::vector<std::vector<double>> rows;
    read.read("path", *node, rows);
    if (rows.empty()) read.fail(*node, "a path without a row", "write [[t, x, y, z], …]");
    path = make_path(rows, kind, [&](std::size_t row, const std::string& what, const std::string& remedy) {
        read.fail(*node, fmt::format("row {} of a path {}", row + 1, what),
                  remedy + (rows[row].size() > 4 ? ", with points in numbers" : ""));
    });
}

void read_fields(Reader& read, Choice& choice) {
    read("below", choice.below, between(0, 1, "", "0.15 is the lowest 15 %"));
    read("nodes", choice.nodes, zero_or_more("", "count nodes from 0"));
    read("near", choice.near, position);
    read("radius", choice.radius, zero_or_more("m"));
    read("box", choice.box, position);
}

// The moduli and stiffnesses of bodies and their regions. Brain has 1e3 to 1e4 Pa, steel 2e11.
const NumberRange modulus = above_zero("Pa", "brain has about 1e4 Pa, skin 1e5").usual(50, 1e9);
const NumberRange stiffness =
    above_zero("N/m", "springs as soft as tissue have about 1 to 1000 N/m").usual(1e-3, 1e6);

void read_fields(Reader& read, Region& region) {
    region.lines = read.lines();
    read_fields(read, region.choice);
    read("labels", region.labels);
    read("label", region.label);
    read("youngs_modulus", region.youngs_modulus, modulus);
    read("stiffness", region.stiffness, stiffness);
    read("factor", region.factor, above_zero("", "2 is twice as stiff as the body").usual(1e-4, 1e4));
}

void read_fields(Reader& read, SpringKinds& springs) {
    const NumberRange some = zero_or_more("N/m", "cloth has about 100 N/m").usual(1e-3, 1e6);
    NumberRange structural = some;
    structural.above = true;
    read("structural", springs.structural, structural);
    read("shear", springs.shear, some);
    read("flexion", springs.flexion, some);
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

const NumberRange tip_damping = zero_or_more("N·s/m", "1 is usual");

void read_friction(Reader& read, Friction& friction) {
    const NumberRange some = zero_or_more("", "0.3 is usual").usual(0, 3);
    read("friction", friction.still, some);
    friction.sliding = std::min(friction.sliding, friction.still);
    read("sliding", friction.sliding, some);
}

void read_fields(Reader& read, Feel& feel) {
    read("stiffness", feel.stiffness, above_zero("N/m", "400 is usual"));
    read("damping", feel.damping, tip_damping);
    read_friction(read, feel.friction);
    read("width", feel.dent_width, above_zero("m", "0.01 is usual").usual(1e-5, 1));
    read("yield", feel.yield, zero_or_more("m", "0.004 keeps what is deeper than 4 mm").usual(1e-6, 1));
}

// What makes a surface, how it looks and how it feels.
void read_surface(Reader& read, BodyRecipe& body) {
    body.lines = read.lines();
    read("name", body.name);
    read("volume", body.volume);
    read_files(read, "surface", body.surface, body.stand_ins);
    read("iso", body.iso);
    read("units", body.units);
    read("rotate", body.rotate);
    read("size", body.size, between(0, 1e4, "m", "0 leaves it as it is"));
    read("centre", body.centre);
    read("move", body.move, position.usual(0, 100));
    read("largest", body.largest);
    read("weld", body.repair.weld, zero_or_more("m"));
    read("specks", body.repair.specks,
         between(0, 0.999, "", "0.01 drops parts shorter than 1 % of the longest"));
    read("solid", body.repair.solid);
    read("voxel", body.repair.voxel, zero_or_more("m"));
    read("smooth", body.smooth, between(0, 1000, "passes"));
    read("faces", body.faces, zero_or_more("", "0 leaves them as they are"));
    read.colour("colour", body.colour);
    read("shine", body.shine, between(0, 1, "", "0 is dull, 1 is wet"));
    read("shade", body.shade);
    read("pressure_scale", body.pressure_scale,
         above_zero("Pa", "a finger presses with about 1e4 Pa").usual(1, 1e7));
    read.table("touch", [&](Reader& inside) { read_fields(inside, body.feel); });
}

// The material of a named tissue, of which the body may say otherwise. Its mass takes the place of a density.
void read_tissue(Reader& read, Material& material) {
    std::string name;
    read("tissue", name);
    if (name.empty()) return;
    material = tissue_named(name, read.where(*read.get("tissue"))).material();
    if (read.has("mass")) material.density = 0;
}

void read_material(Reader& read, BodyRecipe& body) {
    read_tissue(read, body.material);
    read("youngs_modulus", body.material.youngs_modulus, modulus);
    read("poisson", body.material.poisson, between(0, 0.499, "", "organs have 0.45 to 0.49"));
    read("model", body.material.model);
    if (read.has("poisson") && body.material.model == MaterialModel::automatic)
        body.material.model = MaterialModel::tissue;
    read("stiffness", body.material.stiffness, stiffness);
    read.table("springs", [&](Reader& inside) { read_fields(inside, body.springs.emplace()); });
    read("bending", body.bending, zero_or_more("N·m", "cotton has about 1e-5 N·m").usual(1e-9, 10));
    read("density", body.material.density,
         body.is_cloth() ? above_zero("kg/m²", "a shirt has about 0.15 kg/m²").usual(1e-3, 100)
                         : above_zero("kg/m³", "water has 1000 kg/m³").usual(5, 3e4));
    read("mass", body.material.mass, above_zero("kg", "a brain has 1.4 kg").usual(1e-6, 1e4));
    read("damping", body.material.damping, zero_or_more("1/s", "1 to 10 is usual").usual(0, 1e4));
    read("link_damping", body.material.link_damping,
         zero_or_more("s", "1e-5 to 1e-3 is usual").usual(0, 0.1));
    read("links", body.material.links);
}

void read_fields(Reader& read, BodyRecipe& body) {
    constexpr double most_nodes = 1e7;
    read_surface(read, body);
    read("dims", body.dims, between(1, most_nodes, "nodes"));
    read("cloth", body.cloth, between(1, most_nodes, "nodes"));
    read("sheet", body.sheet);
    read("nodes", body.nodes, between(1, most_nodes, "", "20000 is usual"));
    read("spacing", body.spacing, length);
    read("cage", body.cage, between(1, most_nodes, "nodes"));
    read_material(read, body);
    read("mapping", body.mapping);
    read("colour_map", body.colour_map);
    if (!body.colour_map.empty() && !read.has("colour")) body.colour = vec3(1);
    read("normal_map", body.normal_map);
    read("weave", body.weave, between(1, 128, "threads", "write weave = [60, 40]"));
    read.table("pin", [&](Reader& inside) { read_fields(inside, body.pin); });
    read.each("region", [&](Reader& inside) { read_fields(inside, body.regions.emplace_back()); });
}

// ---- colliders ----

const NumberRange extent = above_zero("m").usual(1e-5, 100), side_length = zero_or_more("m").usual(1e-6, 1e4);

void read_shape(Reader& read, Plane& plane) {
    read("normal", plane.normal);
    read("offset", plane.offset, position.usual(0, 100));
}

void read_shape(Reader& read, Sphere& sphere) {
    read("centre", sphere.centre, position);
    read("radius", sphere.radius, extent);
}

void read_shape(Reader& read, Capsule& capsule) {
    read("from", capsule.from, position);
    read("to", capsule.to, position);
    read("radius", capsule.radius, extent);
}

void read_shape(Reader& read, Box& box) {
    vec3 size(0), rotate(0);
    read("centre", box.centre, position);
    read("half", box.half, side_length);
    read("size", size, side_length);
    read("rotate", rotate);
    read("rounding", box.rounding, zero_or_more("m"));
    if (read.has("half") == read.has("size"))
        read.fail("a box needs exactly one of half and size", "give it one of them");
    if (read.has("size")) box.half = 0.5f * size;
    const mat3 axes = turn(rotate);
    box.axes = {axes[0], axes[1], axes[2]};
}

// Where the triangles of a polygon or a field come from.
void read_file(Reader& read, ColliderRecipe& recipe) {
    read("surface", recipe.surface);
    read("units", recipe.units);
    read("rotate", recipe.rotate);
    read("move", recipe.move, position);
}

void read_shape(Reader& read, Polygon& polygon, ColliderRecipe& recipe) {
    std::vector<std::vector<vec3>> triangles;
    read_file(read, recipe);
    read("triangles", triangles);
    read("thickness", polygon.thickness, extent);
    if (read.has("surface") == read.has("triangles"))
        read.fail("a polygon needs exactly one of surface and triangles", "give it one of them");
    if (read.has("triangles") && (read.has("units") || read.has("rotate") || read.has("move")))
        read.fail("a polygon's units, rotate and move are for a surface", "remove them");
    if (read.has("triangles") && triangles.empty())
        read.fail("a polygon without a triangle", "write [[[…], […], […]], …]");
    for (const auto& corners : triangles) {
        if (corners.size() != 3) read.fail("a triangle without three corners", "write [[[…], […], […]], …]");
        polygon.triangles.push_back({corners[0], corners[1], corners[2]});
    }
}

void read_shape(Reader& read, DistanceField& field, ColliderRecipe& recipe) {
    read_file(read, recipe);
    read("spacing", field.spacing, extent);
    if (recipe.surface.empty()) read.fail("a field without a surface", "name a closed mesh");
}

void read_fields(Reader& read, ColliderRecipe& recipe, Scene& scene) {
    int shapes = 0;
    auto shape = [&](const char* key, auto one, auto... more) {
        read.table(key, [&](Reader& inside) {
            ++shapes;
            read_shape(inside, one, more.get()...);
            recipe.collider.shape = one;
        });
    };
    recipe.lines = read.lines();
    shape("plane", Plane{});
    shape("sphere", Sphere{});
    shape("capsule", Capsule{});
    shape("box", Box{});
    shape("polygon", Polygon{}, std::ref(recipe));
    shape("field", DistanceField{}, std::ref(recipe));
    read("friction", recipe.collider.friction,
         zero_or_more("", "wet tissue on steel has 0.1, cloth on wood 0.4").usual(0, 3));
    read("margin", recipe.collider.margin, zero_or_more("m").usual(0, 1));
    read.colour("colour", recipe.colour);
    read_path_value(read, recipe.path, Rows::poses, scene);
    read("about", recipe.about, position);
    read.finish();  // a misspelt shape is named as such
    if (shapes > 1) read.fail("a collider with two shapes", "write one [[collider]] for each");
    if (shapes == 0)
        read.fail("a collider without a shape", "give it a plane, sphere, capsule, box, polygon or field");
}

// ---- moves, tools and wind ----

void read_fields(Reader& read, MoveRecipe& move, Scene& scene) {
    move.lines = read.lines();
    read("body", move.body);
    read.table("nodes", [&](Reader& inside) { read_fields(inside, move.nodes); });
    read_path_value(read, move.path, Rows::poses, scene);
    read("about", move.about, position);
}

const NumberRange side_of_pad = any_number("m", "a fingertip is about 0.015 m wide").usual(1e-4, 1);

void read_fields(Reader& read, ToolRecipe& tool, Scene& scene) {
    tool.lines = read.lines();
    read("name", tool.name);
    read("kind", tool.kind);
    if (tool.kind == ToolKind::drag) tool.stiffness = 50;
    read("device", tool.device);
    read("radius", tool.radius, above_zero("m", "a finger's tip has about 0.01 m").usual(1e-5, 1));
    read("stiffness", tool.stiffness, above_zero("N/m", "400 is usual").usual(1e-3, 1e6));
    read("damping", tool.damping, tip_damping);
    tool.friction.sliding = Friction{}.sliding;  // where it has any
    read_friction(read, tool.friction);
    read("from", tool.from, position);
    read("along", tool.along);
    read("shaft", tool.shaft, zero_or_more("m").usual(0, 10));
    read.table("pad", [&](Reader& inside) {
        Pad& pad = tool.pad.emplace();
        inside("width", pad.width, side_of_pad);
        inside("height", pad.height, side_of_pad);
        inside("columns", pad.columns, between(1, 100));
        inside("rows", pad.rows, between(1, 100));
    });
    read("body", tool.body);
    read("near", tool.near, position);
    read("relative", tool.relative);
    read.colour("colour", tool.colour);
    read_path_value(read, tool.path, Rows::places, scene);
    auto refuse = [&](std::initializer_list<const char*> keys, const std::string& remedy) {
        for (const char* key : keys)
            if (const toml::node* node = read.get(key))
                read.fail(*node, fmt::format("\"{}\" is not a key of a {}", key, name_of(tool.kind)), remedy);
    };
    if (tool.kind == ToolKind::drag)
        refuse({"from", "along", "shaft", "friction", "sliding", "damping"}, "remove it");
    else
        refuse({"body", "near", "relative"}, "remove it, or write kind = \"drag\"");
    if (!presses_bodies(tool.kind)) refuse({"pad"}, "remove it, or write kind = \"press\" or \"touch\"");
    if (feels(tool.kind))
        refuse({"stiffness", "friction", "sliding", "damping"},
               "say it of the surfaces: touch = { stiffness = 400, friction = 0.3 }");
}

const NumberRange air = zero_or_more("kg/m³", "1.2 is usual").usual(0.01, 2000);

// Wind implies air.
void read_wind(Reader& read, Scene& scene) {
    std::optional<vec3> velocity;
    read("velocity", velocity, any_number("m/s", "a storm has 25 m/s").usual(0, 100));
    read_path_value(read, scene.wind, Rows::places, scene);
    if (velocity.has_value() == read.has("path"))
        read.fail("wind needs exactly one of velocity and path", "give it one of them");
    if (velocity) scene.wind = {{0, *velocity}};
    read("density", scene.simulation.air, air);
}

// "auto" or seconds.
void read_step(Reader& read, double& step) {
    const toml::node* node = read.get("step");
    if (!node || node->value_exact<std::string>() == "auto") return;
    if (!node->is_number()) read.wrong("step", *node, "\"auto\" or a number of seconds");
    read("step", step, above_zero("s", "write \"auto\" or seconds, such as 0.001"));
}

// A point, or the name of a body.
void read_look_at(Reader& read, std::variant<std::monostate, vec3, std::string>& look_at) {
    const toml::node* node = read.get("look_at");
    if (!node) return;
    if (const auto name = node->value_exact<std::string>()) {
        look_at = *name;
    } else {
        read.read("look_at", *node, look_at.emplace<vec3>());
    }
}

void read_camera(Reader& read, Scene& scene) {
    read("eye", scene.camera.eye, position);
    read.direction("up", scene.camera.up, "[0, 1, 0]");
    read("angle", scene.camera.angle, between(0.01, 179, "degrees", "35 is usual"));
    read_look_at(read, scene.camera.look_at);
    std::string projection = scene.camera.orthographic ? "orthographic" : "perspective";
    read("projection", projection);
    if (projection != "orthographic" && projection != "perspective")
        read.wrong("projection", *read.get("projection"), "a projection",
                   "choose perspective or orthographic");
    scene.camera.orthographic = projection == "orthographic";
    scene.camera.lines = read.lines();
}

void read_fields(Reader& read, Scene& scene) {
    constexpr float usual_air = 1.2f;  // kg/m³
    std::optional<float> still_air;
    read.table_or_none("simulation", [&](Reader& inside) {
        inside("backend", scene.simulation.backend);
        inside("threads", scene.simulation.threads,
               between(1, most_threads, "", "use no more than the machine has cores"));
        inside("integrator", scene.simulation.integrator);
        read_step(inside, scene.simulation.step);
        inside("gravity", scene.simulation.gravity,
               between(-1e6, 1e6, "m/s²", "the Earth's is 9.81 m/s²").usual(1e-3, 100));
        inside("duration", scene.duration, between(1e-6, 1e6, "s").usual(0, 3600));
        inside("air", still_air, air);
    });
    read.table("wind", [&](Reader& inside) {
        if (still_air && inside.has("density"))
            inside.fail("the air's density is given twice", "remove simulation.air");
        scene.simulation.air = usual_air;
        read_wind(inside, scene);
    });
    if (still_air) scene.simulation.air = *still_air;
    read.table_or_none("camera", [&](Reader& inside) { read_camera(inside, scene); });
    scene.light.direction = upright(sky(scene)) * scene.light.direction;
    read.table_or_none("light", [&](Reader& inside) {
        inside.direction("direction", scene.light.direction, "[0, -1, 0]");
        inside.colour("colour", scene.light.colour, 10);
    });
    read.each("body", [&](Reader& inside) { read_fields(inside, scene.bodies.emplace_back()); });
    read.each("surface", [&](Reader& inside) { read_surface(inside, scene.surfaces.emplace_back()); });
    read.each("collider",
              [&](Reader& inside) { read_fields(inside, scene.colliders.emplace_back(), scene); });
    read.each("move", [&](Reader& inside) { read_fields(inside, scene.moves.emplace_back(), scene); });
    read.each("tool", [&](Reader& inside) { read_fields(inside, scene.tools.emplace_back(), scene); });
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

// The value after the equals sign, parsed as TOML or, if it is not TOML, taken as a string.
toml::table parse_value(const std::string& key, const std::string& value) {
    try {
        return toml::parse("\"" + key + "\" = " + value);
    } catch (const toml::parse_error&) {
        return toml::table{{key, value}};
    }
}

// The path of the key that a change sets: "body.brain.nodes" as three words.
std::vector<std::string> target(const Change& change) {
    return split(change.substr(0, change.find('=')), '.');
}

// Springs take the place of tissue; what a named tissue said of other things stays.
void leave_tissue(toml::table& table, bool keeps_modulus) {
    if (const auto* name = table.get_as<std::string>("tissue")) {
        const Material material = tissue_named(name->get()).material();
        if (!table.contains("mass")) table.insert("density", double(material.density));
        table.insert("damping", double(material.damping));
        if (keeps_modulus) table.insert("youngs_modulus", double(material.youngs_modulus));
    }
    for (const char* of_tissue : {"poisson", "tissue", "model"}) table.erase(of_tissue);
}

// Removes the keys that exclude a changed one; a new tissue removes the numbers given instead of its own.
void remove_excluded(toml::table& table, const std::string& key, const toml::node& value) {
    if (key == "tissue")
        for (const char* other : {"youngs_modulus", "poisson", "model", "stiffness", "springs", "links",
                                  "density", "mass", "damping"})
            table.erase(other);
    if (key == "stiffness" || key == "springs" || key == "links") leave_tissue(table, key == "links");
    if (key == "poisson") table.erase("model");
    const bool of_springs = key == "model" && value.value_or(std::string()) == "springs";
    if (key == "poisson" || (key == "model" && !of_springs)) table.erase("links");
    if (of_springs) table.erase("poisson");
    const std::vector<std::string_view> choices[] = {{"density", "mass"},
                                                     {"youngs_modulus", "stiffness", "springs", "factor"},
                                                     {"nodes", "spacing"},
                                                     {"velocity", "path"},
                                                     {"half", "size"}};
    for (const auto& choice : choices)
        if (std::ranges::count(choice, key) > 0)
            for (std::string_view other : choice)
                if (other != key) table.erase(other);
}

// Whether it names what a body is made from.
bool names_source(const Change& change) {
    const std::vector<std::string> words = target(change);
    constexpr std::string_view sources[] = {"volume", "surface", "dims", "cloth"};
    return words.size() == 3 && (words[0] == "body" || words[0] == "surface") &&
           std::ranges::count(sources, words[2]) > 0;
}

bool names_tissue(const Change& change) {
    const std::vector<std::string> words = target(change);
    return words.size() == 3 && words[0] == "body" && words[2] == "tissue";
}

// The names of tables, and the numbers of those without one: "skin, 2".
std::string names_in(const toml::array& tables) {
    std::string list;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const toml::table* table = tables[i].as_table();
        const auto* name = table ? table->get_as<std::string>("name") : nullptr;
        list += (list.empty() ? "" : ", ") + (name ? name->get() : std::to_string(i + 1));
    }
    return list;
}

// If there are two colliders, "collider.3={…}" adds a third.
void add_one(toml::array& tables, const std::string& key, const Change& change, const SceneSource& source) {
    const std::string list = target(change).front(), text = change.substr(change.find('=') + 1);
    const toml::table value = parse_value(key, text);
    const toml::table* one = value.get_as<toml::table>(key);
    if (key != std::to_string(tables.size() + 1) || !one) {
        const std::string names = names_in(tables), first = names.substr(0, names.find(','));
        const std::string add = fmt::format("{}.{}={{ … }} to add one", list, tables.size() + 1);
        const bool is_name = find_named(tables, key) != nullptr;
        source.fail(0,
                    one || is_name ? "it does not name a key" : fmt::format("it does not say which {}", list),
                    tables.empty() ? "write " + add
                                   : fmt::format("write {}.{}.{}={}, or {}", list, is_name ? key : first,
                                                 one || is_name ? "KEY" : key, one ? "…" : text, add));
    }
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
                source.fail(0, "no " + words[i - 1] + " named " + words[i],
                            "choose from " + names_in(*tables));
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
    remove_excluded(*table, key, *value.get(key));
    table->insert_or_assign(key, *value.get(key));
}

std::string nth_line(const std::string& text, int number) {
    std::istringstream lines(text);
    std::string line;
    for (int i = 0; i < number; ++i) std::getline(lines, line);
    return line;
}

// The unit of a key's numbers ("Pa"), found by reading the scene with its line replaced by `line`; empty if
// that does not find it.
std::string unit_of(const std::string& text, int number, const std::string& line) {
    std::istringstream lines(text);
    std::string corrected;
    int n = 0;
    for (std::string one; std::getline(lines, one);) corrected += (++n == number ? line : one) + "\n";
    const SceneSource source{"a scene"};
    SceneReading reading{source};
    try {
        const toml::table root = toml::parse(corrected);
        Scene scene;
        Reader reader(root, reading, "");
        read_fields(reader, scene);
    } catch (const std::exception&) {  // an error of another line: keys before it have been read
    }
    const auto found = reading.units.find(number);
    return found == reading.units.end() ? "" : found->second;
}

// The remedy for a line that is not TOML, for common mistakes.
std::string advice_on(const std::string& text, int number) {
    const std::string line = nth_line(text, number);
    const std::string value = R"(([+-]?[0-9][0-9_]*(?:[.,][0-9]+)?(?:[eE][+-]?[0-9]+)?))";
    const std::string key = R"(^\s*([A-Za-z_]+)\s*=\s*)", end = R"(\s*(?:#.*)?$)";
    std::smatch found;
    auto is = [&](const std::string& pattern) { return std::regex_search(line, found, std::regex(pattern)); };
    if (is(key + R"(([+-]?[0-9]+,[0-9]+))" + end))
        return "write numbers with a point: " + with_point(found[2]);
    if (is(key + value + R"(\s*([^\s0-9,;\]}#"'=][^\s,;\]}#"'=]*))" + end)) {
        const std::string name = found[1], amount = found[2], given = found[3];
        const std::string corrected = fmt::format("{} = {}", name, with_point(amount));
        const std::string unit = unit_of(text, number, corrected);
        return fmt::format("write the number alone, without {}{}", given,
                           unit.empty() ? "" : ": " + name + " is in " + unit);
    }
    if (is(R"(\[[^\]"]*;)")) return "put commas between the numbers in brackets: [5, 5, 5]";
    if (is(R"(\[\s*[-+0-9.]+\s+[-+0-9.])")) return "put commas between the numbers in brackets: [5, 5, 5]";
    if (is(key + "(True|TRUE|yes|Yes|on|False|FALSE|no|No|off)" + end))
        return fmt::format(
            "write {} = {}", std::string(found[1]),
            std::string("TtYyo").find(found[2].str()[0]) != std::string::npos && found[2] != "off" ? "true"
                                                                                                   : "false");
    if (is(key + R"(([A-Za-z_/.~][^"'#=]*?))" + end))
        return fmt::format("write strings in quotes: {} = \"{}\"", std::string(found[1]),
                           std::string(found[2]));
    return "correct the TOML there";
}

toml::table changed_table(const std::string& text, const SceneSource& source,
                          std::span<const Change> changes) {
    toml::table root;
    try {
        root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        const int line = int(error.source().begin.line);
        source.fail(line, std::string(error.description()), advice_on(text, line));
    }
    // New sources and tissues come first, because they remove the keys of the old ones.
    std::vector<Change> ordered(changes.begin(), changes.end());
    std::stable_partition(ordered.begin(), ordered.end(),
                          [](const Change& change) { return names_source(change) || names_tissue(change); });
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
    scene.file = name;
    scene.folder = folder;
    SceneReading reading{source};
    Reader reader(root, reading, "");
    read_fields(reader, scene);
    scene.notes = std::move(reading.notes);
    check(scene, source);
    return scene;
}

std::string changed(const SceneText& scene, std::span<const Change> changes) {
    std::ostringstream text;
    text << changed_table(scene.text, SceneSource{scene.name}, changes) << '\n';
    return text.str();
}

Scene read_scene(const std::string& file_or_name, std::span<const Change> changes) {
    return parse_scene(find_scene(file_or_name), changes);
}

}  // namespace palpate
