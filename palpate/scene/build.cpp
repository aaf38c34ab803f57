#include "palpate/scene/build.h"

#include "palpate/base/error.h"
#include "palpate/body/cloth.h"
#include "palpate/body/hull.h"
#include "palpate/body/influences.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/files/extension.h"
#include "palpate/files/image_file.h"
#include "palpate/files/read.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/relief.h"
#include "palpate/mesh/repair.h"
#include "palpate/scene/hold.h"
#include "palpate/scene/reading.h"
#include "palpate/scene/surface.h"
#include "palpate/scene/thin_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

void tell(const Progress& progress, const BodyRecipe& recipe, const char* doing, double fraction) {
    if (progress) progress(recipe.name + ": " + doing, fraction);
}

// ---- bodies ----

// The volume of a solid, and that of its cavities, m³.
struct Enclosed {
    double solid = 0, cavities = 0;
};

Enclosed enclosed_by(const Mesh& mesh) {
    Enclosed found;
    for (double volume : volumes(mesh, parts(mesh))) {
        found.solid += volume;
        found.cavities += std::max(-volume, 0.0);
    }
    return found;
}

// Warnings about the body. `filled`: the volume that was filled.
void add_notes(const BodyRecipe& recipe, const Model& model, Enclosed filled,
               std::vector<std::string>& notes) {
    auto note = [&](const std::string& what) {
        notes.push_back(fmt::format("body {}: {}", recipe.name, what));
    };
    const Body& body = model.body;
    if (recipe.dims || recipe.cloth)  // a file's surface has this note already
        if (const std::string warning = size_warning({body.positions, {}, {}}); !warning.empty())
            note(warning);
    if (model.surface.triangles.empty()) {
        note(recipe.cloth ? "one node wide, so it has no surface to draw"
                          : "one node thick, so it has no surface to draw or to embed");
        return;
    }
    if (recipe.dims || recipe.cage || recipe.is_cloth()) return;
    if (recipe.spacing <= 0 && std::abs(double(body.count()) / recipe.nodes - 1) > 0.05)
        note(fmt::format("{} nodes instead of {}: the nearest that a spacing gives", body.count(),
                         recipe.nodes));
    if (filled.cavities > 0.01 * filled.solid)
        note(fmt::format("the lattice fills the surface's cavities too: {:.2g} % of its volume ({:.3g} ml)",
                         100 * filled.cavities / filled.solid, 1e6 * filled.cavities));
    const double cells =
        double(body.cells.size()) * std::pow(body.spacing, 3) / (filled.solid + filled.cavities);
    if (std::abs(cells - 1) < 0.1) return;
    const vec3 size = bounds(model.surface).size();
    const float longest = std::max({size.x, size.y, size.z});
    if (recipe.spacing > longest)
        note(
            fmt::format("spacing is {:.3g} m and the body {:.3g} m long, so its cells hold {:.3g} times its "
                        "volume, and it weighs as much more if density is given; use a smaller spacing",
                        recipe.spacing, longest, cells));
    else
        note(
            fmt::format("the cells hold {:.2f} times the surface's volume: parts are thinner than a cell; "
                        "{} resolves them better",
                        cells, recipe.spacing > 0 ? "a smaller spacing" : "a lattice of more nodes"));
}

ClothSettings cloth_settings(const BodyRecipe& recipe) {
    ClothSettings settings;
    settings.bending = recipe.bending;
    if (recipe.bending > 0) settings.stiffness.flexion = 0;
    if (recipe.springs) settings.stiffness = *recipe.springs;
    settings.density = recipe.material.density;
    settings.mass = recipe.material.mass;
    settings.damping = recipe.material.damping;
    settings.link_damping = recipe.material.link_damping;
    return settings;
}

// A box around the centre of a surface, or a sheet through it; large enough for it unless its spacing is
// given.
Body cage_around(const Mesh& surface, const BodyRecipe& recipe) {
    const ivec3 dims = *recipe.cage;
    const Bounds box = bounds(surface);
    const vec3 cells(dims - 1), fitting = box.size() / glm::max(cells, vec3(1));
    const float widest = std::max({fitting.x, fitting.y, dims.z > 1 ? fitting.z : 0});
    const float spacing = recipe.spacing > 0 ? recipe.spacing : widest;
    Body body = dims.z > 1 ? lattice(dims, spacing, first_material(recipe))
                           : cloth({dims.x, dims.y}, spacing, cloth_settings(recipe));
    for (vec3& p : body.positions) p += box.centre() - 0.5f * spacing * cells;
    return body;
}

Body make_body(const BodyRecipe& recipe, const Mesh& surface, const Progress& progress) {
    if (recipe.cloth) return cloth(*recipe.cloth, recipe.spacing, cloth_settings(recipe));
    if (recipe.cage) return cage_around(surface, recipe);
    if (recipe.sheet) return cloth(surface, cloth_settings(recipe));
    if (recipe.dims && recipe.springs)
        return lattice(*recipe.dims, recipe.spacing, *recipe.springs, recipe.material);
    const Material material = first_material(recipe);
    if (recipe.dims) return lattice(*recipe.dims, recipe.spacing, material);
    return lattice(surface, {.nodes = recipe.nodes, .spacing = recipe.spacing, .material = material},
                   progress);
}

// The surface of a rectangle of cloth; a texture covers all of it.
Mesh cloth_mesh(const Body& body) {
    Mesh mesh = face_mesh(body);
    const vec3 size = bounds(mesh).size();
    for (vec3 p : mesh.positions) mesh.uvs.push_back(vec2(p) / vec2(size));
    return mesh;
}

void read_maps(const BodyRecipe& recipe, const Scene& scene, Model& model) {
    auto read = [&](const char* key, const std::string& file) {
        return reading(scene, "body " + recipe.name, recipe.lines, key,
                       [&] { return read_image(find_data(file, scene.folder)); });
    };
    if (!recipe.colour_map.empty()) model.colour_map = read("colour_map", recipe.colour_map);
    if (!recipe.normal_map.empty()) model.normal_map = read("normal_map", recipe.normal_map);
    if (recipe.weave) model.normal_map = weave(*recipe.weave);
}

// A grid is made, and its surface embedded, at the origin with its sides along the axes.
void place(Model& model, const BodyRecipe& recipe) {
    const mat3 turned = turn(recipe.rotate);
    for (vec3& p : model.body.positions) p = turned * p + recipe.move;
    for (vec3& p : model.surface.positions) p = turned * p + recipe.move;
    for (vec3& n : model.surface.normals) n = turned * n;
    for (vec4& t : model.surface.tangents) t = vec4(turned * vec3(t), t.w);
    model.embedding.edges = turned * model.embedding.edges;
}

// The same recipe with the first of its files that is found; with its first choice if none is.
BodyRecipe with_surface(BodyRecipe recipe, const std::filesystem::path& folder,
                        std::vector<std::string>& notes) {
    if (recipe.surface.empty() || is_found(recipe.surface, folder)) return recipe;
    for (const std::string& other : recipe.stand_ins) {
        if (!is_found(other, folder)) continue;
        notes.push_back(fmt::format("body {}: {} is not found, so {} stands in for it", recipe.name,
                                    recipe.surface, other));
        recipe.surface = other;
        break;
    }
    return recipe;
}

// ---- reusing what has not changed ----

// The recipe without its look and feel.
BodyRecipe without_looks(BodyRecipe recipe) {
    const BodyRecipe plain;
    recipe.colour = plain.colour;
    recipe.shine = plain.shine;
    recipe.shade = plain.shade;
    recipe.pressure_scale = plain.pressure_scale;
    recipe.feel = plain.feel;
    return recipe;
}

// The recipe without its material, pins and mapping.
BodyRecipe without_material(BodyRecipe recipe) {
    const BodyRecipe plain;
    recipe = without_looks(std::move(recipe));
    recipe.material = plain.material;
    recipe.pin = plain.pin;
    recipe.regions = plain.regions;
    recipe.mapping = plain.mapping;
    return recipe;
}

// The recipe of its surface alone.
BodyRecipe without_body(BodyRecipe recipe) {
    const BodyRecipe plain;
    recipe = without_material(std::move(recipe));
    recipe.nodes = plain.nodes;
    recipe.spacing = plain.spacing;
    recipe.springs = plain.springs;
    recipe.bending = plain.bending;
    return recipe;
}

bool looks_down(const BodyRecipe& recipe) {
    return recipe.pin.below || recipe.bears_its_weight() ||
           std::ranges::any_of(recipe.regions,
                               [](const Region& region) { return region.choice.below.has_value(); });
}

// The models of a scene before it was changed.
struct Earlier {
    const Scene& scene;
    const Models& made;

    // The index of a body that was made from the same recipe, apart from what `but_for` removes.
    std::optional<std::size_t> find(const BodyRecipe& recipe, BodyRecipe (*but_for)(BodyRecipe)) const {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (but_for(scene.bodies[i]) == but_for(recipe)) return i;
        return std::nullopt;
    }
    const Model* model(const BodyRecipe& recipe, BodyRecipe (*but_for)(BodyRecipe)) const {
        const auto number = find(recipe, but_for);
        return number ? &made.models[*number] : nullptr;
    }
    const StaticSurface* still(const BodyRecipe& recipe) const {
        for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
            if (without_looks(scene.surfaces[i]) == without_looks(recipe)) return &made.static_surfaces[i];
        return nullptr;
    }
};

// The whole body, unless its nodes depend on the direction of gravity or on a motion that has changed.
const Model* unchanged(const BodyRecipe& recipe, const Scene& scene, const Earlier* earlier) {
    if (!earlier || scene.moves != earlier->scene.moves) return nullptr;
    if (looks_down(recipe) && down(scene) != down(earlier->scene)) return nullptr;
    return earlier->model(recipe, without_looks);
}

CleanSurface read_and_mend(const BodyRecipe& recipe, const std::string& whose, const Scene& scene,
                           const Progress& progress) {
    return reading(scene, whose, recipe.lines, recipe.volume.empty() ? "surface" : "volume",
                   [&] { return make_surface(recipe, scene.folder, progress); });
}

CleanSurface surface_of(const BodyRecipe& recipe, const Scene& scene, const Earlier* earlier,
                        const Progress& progress) {
    const Model* old = earlier && !recipe.is_textured() ? earlier->model(recipe, without_body) : nullptr;
    if (!old || old->surface.triangles.empty())
        return read_and_mend(recipe, "body " + recipe.name, scene, progress);
    CleanSurface made;
    made.mesh = old->surface;
    made.steps = old->steps;
    return made;
}

// The same nodes with another material, other pins or another mapping; nothing if more than that has changed.
// Grids without a mesh and cloths are faster to make again.
std::optional<Model> restuffed(const BodyRecipe& recipe, const Scene& scene, const Earlier* earlier,
                               std::vector<std::string>& notes) {
    if (recipe.dims || recipe.cage || recipe.is_cloth() || recipe.is_textured() || !earlier)
        return std::nullopt;
    const auto number = earlier->find(recipe, without_material);
    if (!number) return std::nullopt;
    const BodyRecipe& before = earlier->scene.bodies[*number];
    Model model = earlier->made.models[*number];
    if (!restuff(model.body, first_material(before), first_material(recipe), volume(model.surface)))
        return std::nullopt;
    if (recipe.mapping != before.mapping) model.embedding = embed(model.surface, model.body, recipe.mapping);
    hold(model.body, recipe, scene, notes);
    return model;
}

Model build_one(const BodyRecipe& wanted, const Scene& scene, const Earlier* earlier,
                std::vector<std::string>& notes, const Progress& progress) {
    if (const Model* same = unchanged(wanted, scene, earlier)) return *same;
    if (auto other = restuffed(wanted, scene, earlier, notes)) return std::move(*other);
    const BodyRecipe recipe = with_surface(wanted, scene.folder, notes);
    const bool grid = recipe.dims || recipe.cloth;
    CleanSurface made;
    if (!grid) made = surface_of(recipe, scene, earlier, progress);
    for (const std::string& note : made.notes) notes.push_back(fmt::format("body {}: {}", recipe.name, note));
    const Enclosed filled = enclosed_by(made.mesh);
    tell(progress, recipe, recipe.is_cloth() ? "making cloth" : "filling with a lattice", 0.6);
    Model model;
    model.body = make_body(recipe, made.mesh, progress);
    model.body.name = recipe.name;
    model.steps = std::move(made.steps);
    if (recipe.dims)
        model.surface = hull_mesh(model.body);
    else if (recipe.cloth)
        model.surface = cloth_mesh(model.body);
    else
        model.surface = std::move(recipe.is_textured() ? made.drawn : made.mesh);
    if (recipe.has_normal_map() && !model.surface.triangles.empty()) compute_tangents(model.surface);
    read_maps(recipe, scene, model);
    tell(progress, recipe, "embedding the surface", 0.9);
    if (!model.surface.positions.empty() && !model.surface.triangles.empty())
        model.embedding = embed(model.surface, model.body, recipe.mapping);
    else
        model.surface = {};  // nothing to draw without faces
    if (grid) place(model, recipe);

    hold(model.body, recipe, scene, notes);
    add_notes(recipe, model, filled, notes);
    return model;
}

StaticSurface build_static_surface(const BodyRecipe& wanted, const Scene& scene, const Earlier* earlier,
                                   std::vector<std::string>& notes, const Progress& progress) {
    if (const StaticSurface* same = earlier ? earlier->still(wanted) : nullptr) return *same;
    const BodyRecipe recipe = with_surface(wanted, scene.folder, notes);
    CleanSurface made = read_and_mend(recipe, "surface " + recipe.name, scene, progress);
    for (const std::string& note : made.notes)
        notes.push_back(fmt::format("surface {}: {}", recipe.name, note));
    return {recipe.name, std::move(made.mesh), std::move(made.steps)};
}

// ---- prescribed motion ----

MovedNodes find_moved(const MoveRecipe& recipe, std::size_t number, const Scene& scene,
                      const std::vector<Model>& models, std::vector<std::string>& notes) {
    MovedNodes moved;
    while (scene.bodies[moved.body].name != recipe.body) ++moved.body;
    const Body& body = models[moved.body].body;
    moved.nodes =
        chosen(body, recipe.nodes, scene, recipe.lines, fmt::format("move {}", number), "nodes.", notes);
    Bounds box;
    for (int node : moved.nodes) box.include(body.positions[std::size_t(node)]);
    moved.about = recipe.about.value_or(box.empty() ? vec3(0) : box.centre());
    return moved;
}

// Finds paths that lead far away from everything, as those in millimetres do.
void check_paths(const Scene& scene, Models& made) {
    Bounds all;
    for (const Model& model : made.models)
        for (vec3 p : model.body.positions) all.include(p);
    for (const StaticSurface& still : made.static_surfaces)
        for (vec3 p : still.surface.positions) all.include(p);
    const float size = glm::length(all.size());
    auto check = [&](const std::string& whose, const Path& path, const Lines& lines, vec3 origin) {
        float farthest = 0;
        for (const Waypoint& point : path)
            farthest = std::max(farthest, glm::distance(point.position, origin));
        if (farthest < 20 * size || farthest < 1) return;
        const int line = lines.of("path");
        made.notes.push_back(
            fmt::format("{}: its path{} leads {:.3g} m away, {:.0f} times the size of all bodies; "
                        "paths are in m, so divide millimetres by 1000",
                        whose, line > 0 ? fmt::format(" (line {})", line) : "", farthest, farthest / size));
    };
    for (const ToolRecipe& tool : scene.tools)
        check("tool " + tool.name, tool.path, tool.lines,
              tool.from || tool.relative ? vec3(0) : all.centre());
    for (std::size_t i = 0; i < scene.moves.size(); ++i)
        check(fmt::format("move {}", i + 1), scene.moves[i].path, scene.moves[i].lines, vec3(0));
    for (std::size_t i = 0; i < scene.colliders.size(); ++i)
        check(fmt::format("collider {}", i + 1), scene.colliders[i].path, scene.colliders[i].lines, vec3(0));
}

// ---- files ----

// The kind of a file that does not fit its key ("a volume"), and what to write instead; empty if it fits.
struct Mistaken {
    std::string kind, remedy;
};

Mistaken mistaken(const std::string& key, const std::string& name, const std::filesystem::path& file) {
    const bool wants_volume = key == "volume" || key == "labels", wants_surface = key.ends_with("surface");
    if (extension(file) == ".toml") return {"a scene", "run it by itself, or name a mesh or a volume"};
    if (wants_volume && is_mesh(file))
        return {"a mesh", key == "volume" ? fmt::format("write surface = \"{}\"", name) : "name a volume"};
    if (!wants_surface || is_mesh(file)) return {};
    if (std::filesystem::is_directory(file))
        return {"a folder", key == "surface" ? "name a mesh; a folder of DICOM slices goes under volume = …"
                                             : "name a mesh"};
    if (is_volume(file))
        return {"a volume", key == "surface" ? fmt::format("write volume = \"{}\"", name)
                                             : "make a mesh of it first: palpate import"};
    return {};
}

// The key of a collider that names a file.
const char* file_key(const ColliderRecipe& recipe) {
    return std::holds_alternative<Polygon>(recipe.collider.shape) ? "polygon.surface" : "field.surface";
}

}  // namespace

std::vector<std::filesystem::path> find_files(const Scene& scene) {
    std::vector<std::filesystem::path> files = scene.path_files;
    if (std::error_code error; std::filesystem::is_regular_file(scene.file, error))
        files.push_back(scene.file);
    auto want = [&](const std::string& whose, const Lines& lines, const char* key, const std::string& file) {
        if (file.empty()) return;
        if (!is_found(file, scene.folder))
            throw Error(fmt::format("cannot find the {} of {}, {},", key, whose, file),
                        lines.where(key, scene.file), remedy_for_missing(file, scene.folder));
        const std::filesystem::path found = find_data(file, scene.folder);
        if (const Mistaken other = mistaken(key, file, found); !other.kind.empty())
            throw Error(fmt::format("{} of {} is {}, which is {},", key, whose, file, other.kind),
                        lines.where(key, scene.file), other.remedy);
        files.push_back(found);
    };
    auto want_surface = [&](const std::string& whose, const BodyRecipe& recipe) {
        std::vector<std::string> ignored;
        want(whose, recipe.lines, "volume", recipe.volume);
        want(whose, recipe.lines, "surface", with_surface(recipe, scene.folder, ignored).surface);
        want(whose, recipe.lines, "colour_map", recipe.colour_map);
        want(whose, recipe.lines, "normal_map", recipe.normal_map);
        for (const Region& region : recipe.regions) want(whose, region.lines, "labels", region.labels);
    };
    for (const BodyRecipe& body : scene.bodies) want_surface("body " + body.name, body);
    for (const BodyRecipe& surface : scene.surfaces) want_surface("surface " + surface.name, surface);
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        const ColliderRecipe& collider = scene.colliders[i];
        want(fmt::format("collider {}", i + 1), collider.lines, file_key(collider), collider.surface);
    }
    return files;
}

namespace {

// ---- colliders ----

constexpr double most_field_points = 3e7, most_points_unasked = 1 << 24;  // 64 MiB

Mesh read_shape(const ColliderRecipe& recipe, const Scene& scene, const std::string& where,
                std::vector<std::string>& notes) {
    std::vector<std::string> of_file;
    Mesh mesh = reading(scene, where, recipe.lines, file_key(recipe), [&] {
        return read_mesh(find_data(recipe.surface, scene.folder), recipe.units, &of_file);
    });
    for (const std::string& note : of_file) notes.push_back(fmt::format("{}: {}", where, note));
    weld(mesh);
    drop_collapsed(mesh);
    rotate(mesh, recipe.rotate);
    for (vec3& p : mesh.positions) p += recipe.move;
    return mesh;
}

// Without degenerate triangles, which have no normal.
Polygon polygon_of(const Mesh& mesh, float thickness) {
    Polygon polygon{{}, thickness};
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        if (glm::length(glm::cross(b - a, c - a)) > 0) polygon.triangles.push_back({a, b, c});
    }
    return polygon;
}

double field_points(vec3 size, float spacing) {
    const dvec3 points = glm::ceil(dvec3(size) / double(spacing)) + 7.0;
    return points.x * points.y * points.z;
}

// The spacing of a field for which none is given: a 64th of the longest side; finer where the walls of a
// closed mesh need it and memory suffices for that.
float field_spacing(const Mesh& mesh) {
    constexpr float good = 4, needed = 2;  // spacings from side to side of a wall
    const vec3 size = bounds(mesh).size();
    const float usual = std::max({size.x, size.y, size.z}) / 64;
    if (soundness(mesh).open_edges > 0) return usual;
    const float wall = wall_thickness(mesh);
    float spacing = usual;
    while (good * spacing > wall) {
        const float finer = std::max(wall / good, 0.95f * spacing);
        if (field_points(size, finer) > most_points_unasked) break;
        spacing = finer;
    }
    return needed * spacing > wall ? usual : spacing;
}

DistanceField field_of(const Mesh& mesh, float spacing, const std::string& where) {
    if (mesh.triangles.empty()) throw Error("a surface that encloses nothing", where, "name a closed mesh");
    if (!(spacing > 0)) spacing = field_spacing(mesh);
    if (const double points = field_points(bounds(mesh).size(), spacing); !(points <= most_field_points))
        throw Error(fmt::format("a field with a spacing of {} m would need {:.3g} points", spacing, points),
                    where, "use a larger spacing");
    return distance_field(mesh, spacing);
}

vec3 middle(const Plane& plane) { return plane.offset * plane.normal; }
vec3 middle(const Sphere& sphere) { return sphere.centre; }
vec3 middle(const Capsule& capsule) { return 0.5f * (capsule.from + capsule.to); }
vec3 middle(const Box& box) { return box.centre; }
vec3 middle(const Polygon& polygon) {
    Bounds box;
    for (const auto& corners : polygon.triangles)
        for (vec3 p : corners) box.include(p);
    return box.centre();
}
vec3 middle(const DistanceField& field) { return field.origin + 0.5f * field.spacing * vec3(field.dims - 1); }

void shift(Plane& plane, vec3 by) { plane.offset += glm::dot(plane.normal, by); }
void shift(Sphere& sphere, vec3 by) { sphere.centre += by; }
void shift(Capsule& capsule, vec3 by) {
    capsule.from += by;
    capsule.to += by;
}
void shift(Box& box, vec3 by) { box.centre += by; }
void shift(Polygon& polygon, vec3 by) {
    for (auto& corners : polygon.triangles)
        for (vec3& p : corners) p += by;
}
void shift(DistanceField& field, vec3 by) { field.origin += by; }

// Adds a collider; a moving one is given relative to its pivot, so that it also rotates about it within a
// frame.
void add_collider(const ColliderRecipe& recipe, const Scene& scene, Models& result) {
    const std::string where = fmt::format("collider {}", result.pivots.size() + 1);
    Collider collider = recipe.collider;
    std::optional<vec3> about = recipe.about;
    if (!recipe.surface.empty()) {
        const Mesh mesh = read_shape(recipe, scene, where, result.notes);
        if (!about) about = bounds(mesh).centre();
        if (const auto* polygon = std::get_if<Polygon>(&collider.shape)) {
            collider.shape = polygon_of(mesh, polygon->thickness);
        } else {
            if (const std::size_t open = soundness(mesh).open_edges; open > 0)
                result.notes.push_back(fmt::format(
                    "{}: its surface has {} open edges, so what is inside is a guess; close it first", where,
                    open));
            DistanceField field = reading(scene, where, recipe.lines, "field.surface", [&] {
                return field_of(mesh, std::get<DistanceField>(collider.shape).spacing, where);
            });
            if (const auto thin = thin_walls(mesh, field)) {
                const bool fits = field_points(bounds(mesh).size(), thin->spacing) <= most_field_points;
                result.notes.push_back(fmt::format(
                    "{}: {:.0f} % of its walls are thinner than twice the {:.3g} m between the points of its "
                    "field, down to {:.3g} m, so nodes may sink in or pass through; {}",
                    where, 100 * thin->share, field.spacing, thin->thinnest,
                    fits ? fmt::format("use spacing = {:.2g}", thin->spacing)
                         : "use a box, a polygon or thicker walls"));
            }
            collider.shape = std::move(field);
        }
    }
    vec3 pivot(0);
    if (!recipe.path.empty()) {
        pivot = about.value_or(std::visit([](const auto& s) { return middle(s); }, collider.shape));
        std::visit([&](auto& s) { shift(s, -pivot); }, collider.shape);
    }
    result.simulation.colliders.push_back(std::move(collider));
    result.pivots.push_back(pivot);
}

Models build_all(const Scene& scene, const Earlier* earlier, const Progress& progress) {
    Models result;
    result.notes = scene.notes;
    for (const BodyRecipe& recipe : scene.bodies)
        result.models.push_back(build_one(recipe, scene, earlier, result.notes, progress));
    for (const BodyRecipe& recipe : scene.surfaces)
        result.static_surfaces.push_back(
            build_static_surface(recipe, scene, earlier, result.notes, progress));
    for (std::size_t i = 0; i < scene.moves.size(); ++i) {
        result.moves.push_back(find_moved(scene.moves[i], i + 1, scene, result.models, result.notes));
        pin(result.models[result.moves[i].body].body, result.moves[i].nodes);
    }
    if (!scene.simulation.colliders.empty())
        throw Error("colliders in the simulation of a scene", "the scene",
                    "give them as recipes, in Scene::colliders");
    result.simulation = scene.simulation;
    for (const ColliderRecipe& recipe : scene.colliders) add_collider(recipe, scene, result);
    check_paths(scene, result);
    return result;
}

}  // namespace

Models build(const Scene& scene, const Progress& progress) {
    find_files(scene);  // before long work begins
    return build_all(scene, nullptr, progress);
}

Models rebuild(const Scene& scene, const Scene& before, const Models& made, const Progress& progress) {
    const Earlier earlier{before, made};
    return build_all(scene, &earlier, progress);
}

}  // namespace palpate
