#include "palpate/base/files.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// ---- what a scene file may hold ----

void read_fields(Reader& read, Pin& pin) {
    read("below", pin.below);
    read("nodes", pin.nodes);
    read("near", pin.near);
    read("radius", pin.radius);
    read("box", pin.box);
}

void read_fields(Reader& read, BodyRecipe& body) {
    read("name", body.name);
    read("volume", body.volume);
    read("surface", body.surface);
    read("dims", body.dims);
    read("iso", body.iso);
    read("units", body.units);
    read("rotate", body.rotate);
    read("move", body.move);
    read("largest", body.largest);
    read("smooth", body.smooth);
    read("faces", body.faces);
    read("nodes", body.nodes);
    read("spacing", body.spacing);
    read("youngs_modulus", body.material.youngs_modulus);
    read("stiffness", body.material.stiffness);
    read("density", body.material.density);
    read("mass", body.material.mass);
    read("damping", body.material.damping);
    read("links", body.material.links);
    read("mapping", body.mapping);
    read("colour", body.colour);
    read("shine", body.shine);
    read.table("pin", [&](Reader& inside) { read_fields(inside, body.pin); });
}

Collider read_collider(Reader& read, const Source& source, int line) {
    std::optional<Collider> collider;
    read.table("plane", [&](Reader& inside) {
        Plane plane;
        inside("normal", plane.normal);
        inside("offset", plane.offset);
        if (!(glm::length(plane.normal) > 0))
            source.fail(line, "a plane whose normal is zero", "give it a direction");
        plane.normal = glm::normalize(plane.normal);
        collider = Collider{plane};
    });
    read.table("sphere", [&](Reader& inside) {
        Sphere sphere;
        inside("centre", sphere.centre);
        inside("radius", sphere.radius);
        if (!(sphere.radius > 0))
            source.fail(line, "a sphere whose radius is not above zero", "give it one in m");
        collider = Collider{sphere};
    });
    if (read.has("plane") && read.has("sphere"))
        source.fail(line, "a collider with two shapes", "write one [[collider]] for each");
    if (!collider) source.fail(line, "a collider without a shape", "give it a plane or a sphere");
    return *collider;
}

// A path is the name of a file, or rows of [t, x, y, z].
Path read_path_value(const Reader& read, const toml::node& node, const Source& source,
                     const std::filesystem::path& folder) {
    if (const auto file = node.value_exact<std::string>()) return read_path(find_data(*file, folder));
    std::vector<std::vector<double>> rows;
    read.read("path", node, rows);
    Path path;
    for (const auto& row : rows) {
        if (row.size() != 4)
            source.fail(line_of(node), "a row of a path is not [t, x, y, z]", "give it four numbers");
        if (!path.empty() && row[0] <= path.back().time)
            source.fail(line_of(node), "a path goes back in time", "sort its rows by their first number");
        path.push_back({row[0], vec3(row[1], row[2], row[3])});
        if (!(glm::length(path.back().position) < 1e6f))
            source.fail(line_of(node), "a path leads out of the world", "keep it within 1000 km");
    }
    return path;
}

void read_fields(Reader& read, ToolRecipe& tool, const Source& source, const std::filesystem::path& folder) {
    read("name", tool.name);
    read("kind", tool.kind);
    read("device", tool.device);
    read("radius", tool.radius);
    read("stiffness", tool.stiffness);
    read("from", tool.from);
    read("along", tool.along);
    read("colour", tool.colour);
    if (const toml::node* node = read.get("path")) tool.path = read_path_value(read, *node, source, folder);
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

void read_fields(Reader& read, Scene& scene, const Source& source) {
    read.table("simulation", [&](Reader& inside) {
        inside("backend", scene.simulation.backend);
        inside("integrator", scene.simulation.integrator);
        read_step(inside, scene.simulation.step);
        inside("gravity", scene.simulation.gravity);
        inside("duration", scene.duration);
    });
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
    read.each("collider", [&](Reader& inside, int line) {
        scene.simulation.colliders.push_back(read_collider(inside, source, line));
    });
    read.each("tool", [&](Reader& inside, int line) {
        ToolRecipe& tool = scene.tools.emplace_back();
        tool.line = line;
        read_fields(inside, tool, source, scene.folder);
    });
    read.finish();
}

// ---- what must hold of it ----

void check(const BodyRecipe& body, const Source& source) {
    const std::string name = "body " + body.name;
    auto require = [&](bool holds, const std::string& what, const std::string& remedy) {
        if (!holds) source.fail(body.line, name + ": " + what, remedy);
    };
    const Material& m = body.material;
    const int sources = !body.volume.empty() + !body.surface.empty() + body.dims.has_value();
    require(sources == 1, "wants exactly one of volume, surface and dims", "give it one");
    require(body.volume.empty() || body.iso, "a volume without iso", "say at which value its surface lies");
    require((m.youngs_modulus > 0) != (m.stiffness > 0),
            "wants youngs_modulus or stiffness, one of them above zero", "give it one");
    require((m.density > 0) != (m.mass > 0), "wants density or mass, one of them above zero", "give it one");
    require(std::min(
                {m.youngs_modulus, m.stiffness, m.density, m.mass, m.damping, body.spacing, body.shine}) >= 0,
            "a negative number where none makes sense", "use a positive one");
    require(body.nodes > 0 && body.nodes <= 10'000'000, "nodes is not from 1 to 10 million",
            "choose a number there");
    require(body.faces >= 0 && body.smooth.value_or(0) >= 0 && body.smooth.value_or(0) <= 1000,
            "faces or smooth is out of range", "use 0 or more, and at most 1000 passes");
    if (body.dims) {
        const ivec3 d = *body.dims;
        require(std::min({d.x, d.y, d.z}) >= 1 && double(d.x) * d.y * d.z <= 1e7,
                "dims is not at least 1 along each axis and at most 10 million nodes", "change it");
        require(body.spacing > 0, "dims without spacing", "say how far apart the nodes are, in m");
    }
    require(
        !body.dims || (!body.iso && !body.units && !body.smooth && body.faces == 0 && body.rotate == vec3(0)),
        "dims beside iso, units, smooth, faces or rotate, which mean nothing there", "remove them");
    require(body.volume.empty() == !body.iso, "iso without a volume", "remove it");
    require(body.pin.near || body.pin.radius == 0, "pin.radius without pin.near", "say around which point");
    require(body.pin.box.empty() || body.pin.box.size() == 2, "pin.box is not two corners",
            "write [[…], […]]");
    if (body.pin.below)
        require(*body.pin.below >= 0 && *body.pin.below <= 1, "pin.below is not from 0 to 1",
                "0.15 is the lowest 15 %");
}

void check(const ToolRecipe& tool, const Source& source) {
    auto require = [&](bool holds, const std::string& what, const std::string& remedy) {
        if (!holds) source.fail(tool.line, "tool " + tool.name + ": " + what, remedy);
    };
    require(tool.kind == "press", "no kind \"" + tool.kind + "\"", "the kind there is: press");
    require(tool.device == "script", "no device \"" + tool.device + "\"", "the device there is: script");
    require(tool.radius > 0 && tool.stiffness > 0, "radius and stiffness must be above zero",
            "give both, in m and N/m");
    require(!tool.path.empty(), "no path", "give it a file or rows of [t, x, y, z]");
    require(!tool.from || glm::length(tool.along) > 0, "along is zero", "give it a direction");
}

// Names become parts of file names and cells of tables.
void check_name(const std::string& name, int line, const Source& source) {
    for (unsigned char c : name)
        if (c < ' ' || std::string_view("/\\,\"").find(char(c)) != std::string_view::npos)
            source.fail(line, "a name with a slash, a comma, a quote or an unprintable letter",
                        "choose another");
}

void check(Scene& scene, const Source& source) {
    if (scene.bodies.empty()) source.fail(0, "no body", "add a [[body]]");
    std::set<std::string> names;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        BodyRecipe& body = scene.bodies[i];
        if (body.name.empty()) body.name = fmt::format("body{}", i + 1);
        check_name(body.name, body.line, source);
        if (!names.insert(body.name).second)
            source.fail(body.line, "a second body named " + body.name, "give each its own name");
        check(body, source);
    }
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
        if (scene.tools[i].name.empty()) scene.tools[i].name = fmt::format("tool{}", i + 1);
        check_name(scene.tools[i].name, scene.tools[i].line, source);
        check(scene.tools[i], source);
    }
    if (scene.tools.size() > 8) source.fail(0, "more than 8 tools", "use fewer");
    if (const auto* name = std::get_if<std::string>(&scene.look_at); name && !names.contains(*name))
        source.fail(0, "camera.look_at names no body: " + *name, "name one of the bodies, or give a point");
    if (!(scene.duration > 0 && scene.duration <= 1e6))
        source.fail(0, "duration is not above zero", "give it in seconds");
    if (!(scene.camera.angle > 0 && scene.camera.angle < 180))
        source.fail(0, "camera.angle is not between 0 and 180 degrees", "35 is usual");
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

void apply(toml::table& root, const Change& change) {
    const Source source{"--set " + change};
    const auto equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
        source.fail(0, "no value", "write --set body.brain.nodes=5000");
    std::vector<std::string> words = split(change.substr(0, equals), '.');
    const std::string key = words.back();
    words.pop_back();

    toml::table* table = &root;
    for (std::size_t i = 0; i < words.size(); ++i) {
        toml::node* node = table->get(words[i]);
        if (toml::array* tables = node ? node->as_array() : nullptr) {
            if (i + 1 == words.size()) source.fail(0, "no name after " + words[i], "name one of them");
            table = find_named(*tables, words[++i]);
            if (!table)
                source.fail(0, "no " + words[i - 1] + " named " + words[i], "use a name from the scene");
        } else {
            if (!node) node = &table->insert(words[i], toml::table{}).first->second;
            table = node->as_table();
            if (!table) source.fail(0, "\"" + words[i] + "\" is not a table", "name a key of the scene");
        }
    }
    toml::table value = parse_value(key, change.substr(equals + 1));
    if (!value.contains(key)) source.fail(0, "no value", "write one after the equals sign");
    table->insert_or_assign(key, *value.get(key));
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  std::span<const Change> changes) {
    const Source source{name};
    toml::table root;
    try {
        root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        source.fail(int(error.source().begin.line), std::string(error.description()),
                    "correct the TOML there");
    }
    for (const Change& change : changes) apply(root, change);
    Scene scene;
    scene.name = std::filesystem::path(name).stem().string();
    scene.folder = folder;
    Reader reader(root, source, "a scene");
    read_fields(reader, scene, source);
    check(scene, source);
    return scene;
}

Scene read_scene(const std::string& file_or_name, std::span<const Change> changes) {
    for (const ShippedScene& shipped : shipped_scenes())
        if (shipped.name == file_or_name)
            return parse_scene(shipped.text, shipped.name, std::filesystem::current_path(), changes);
    if (std::error_code error; !std::filesystem::exists(file_or_name, error)) {
        std::string list;
        for (const ShippedScene& shipped : shipped_scenes())
            list += (list.empty() ? "" : ", ") + shipped.name;
        throw Error("no such scene", file_or_name, "give a TOML file, or one of: " + list);
    }
    return parse_scene(read_text(file_or_name), file_or_name,
                       std::filesystem::path(file_or_name).parent_path(), changes);
}

}  // namespace palpate
