#include "palpate/scene/build.h"

#include "palpate/base/error.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/mesh/read.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

void tell(const Progress& progress, const BodyRecipe& recipe, const char* doing, double fraction) {
    if (progress) progress(recipe.name + ": " + doing, fraction);
}

// A pin that holds nothing is a note: the body would fall.
std::vector<int> pinned_nodes(const Body& body, const BodyRecipe& recipe, vec3 gravity,
                              std::vector<std::string>& notes) {
    std::vector<int> all;
    auto add = [&](const char* which, const std::vector<int>& nodes) {
        if (nodes.empty()) notes.push_back(fmt::format("body {}: pin.{} holds no node", recipe.name, which));
        all.insert(all.end(), nodes.begin(), nodes.end());
    };
    const Pin& pin = recipe.pin;
    const vec3 down = glm::length(gravity) > 0 ? glm::normalize(gravity) : vec3(0, -1, 0);
    if (pin.below) add("below", nodes_below(body, *pin.below, down));
    if (pin.near) add("near", nodes_near(body, *pin.near, pin.radius));
    if (pin.box.size() == 2) {
        Bounds box;
        for (vec3 corner : pin.box) box.include(corner);
        add("box", nodes_in(body, box));
    }
    for (int node : pin.nodes)
        if (node < 0 || node >= int(body.count()))
            throw Error(fmt::format("pin.nodes names node {} of {}", node, body.count()),
                        "body " + recipe.name, "count nodes from 0");
    if (!pin.nodes.empty()) add("nodes", pin.nodes);
    return all;
}

// What the user should know of what came out.
void add_notes(const BodyRecipe& recipe, const Model& model, std::vector<std::string>& notes) {
    auto note = [&](const std::string& what) {
        notes.push_back(fmt::format("body {}: {}", recipe.name, what));
    };
    const Body& body = model.body;
    if (recipe.dims && body.cells.empty())
        note("one node thick, so it has no surface to draw or to hang on it");
    if (body.cells.empty()) return;
    if (const std::string warning = size_warning(model.surface); !warning.empty()) note(warning);
    if (recipe.dims) return;
    if (recipe.spacing <= 0 && std::abs(double(body.count()) / recipe.nodes - 1) > 0.05)
        note(fmt::format("{} nodes instead of {}: the nearest that a spacing gives", body.count(),
                         recipe.nodes));
    if (const std::size_t open = soundness(model.surface).open_edges; open > 0)
        note(
            fmt::format("its surface has {} open edges, so what is inside is a guess; close it first", open));
    const double filled = double(body.cells.size()) * std::pow(body.spacing, 3) / volume(model.surface);
    if (!(std::abs(filled - 1) < 0.1))
        note(fmt::format(
            "the cells hold {:.2f} times the surface's volume: parts are thinner than a cell, or sealed "
            "hollows count as full",
            filled));
}

Body make_body(const BodyRecipe& recipe, const Mesh& surface, const Progress& progress) {
    if (recipe.dims) {
        Body body = lattice(*recipe.dims, recipe.spacing, recipe.material);
        for (vec3& p : body.positions) p += recipe.move;
        return body;
    }
    return lattice(surface, {.nodes = recipe.nodes, .spacing = recipe.spacing, .material = recipe.material},
                   progress);
}

Model build_one(const BodyRecipe& recipe, const Scene& scene, std::vector<std::string>& notes,
                const Progress& progress) {
    Model model;
    if (!recipe.dims) model.surface = make_surface(recipe, scene.folder, progress).mesh;
    tell(progress, recipe, "filling with a lattice", 0.6);
    model.body = make_body(recipe, model.surface, progress);
    model.body.name = recipe.name;
    if (recipe.dims) model.surface = hull_mesh(model.body);
    tell(progress, recipe, "hanging the surface on it", 0.9);
    model.embedding = embed(model.surface, model.body, recipe.mapping);

    pin(model.body, pinned_nodes(model.body, recipe, scene.simulation.gravity, notes));
    add_notes(recipe, model, notes);
    return model;
}

}  // namespace

CleanSurface make_surface(const BodyRecipe& recipe, const std::filesystem::path& folder,
                          const Progress& progress) {
    CleanSurface surface;
    Mesh& mesh = surface.mesh;
    auto did = [&](const std::string& what) { surface.steps.push_back(what); };
    tell(progress, recipe, "reading", 0);
    if (!recipe.volume.empty()) {
        const Volume volume =
            read_volume(find_data(recipe.volume, folder), recipe.units.value_or(Units::millimetres));
        tell(progress, recipe, "finding the surface", 0.1);
        mesh = isosurface(volume, *recipe.iso);
        did(fmt::format("surface at {} of {} x {} x {} voxels: {} faces", *recipe.iso, volume.dims.x,
                        volume.dims.y, volume.dims.z, mesh.triangles.size()));
    } else {
        mesh = read_mesh(find_data(recipe.surface, folder), recipe.units.value_or(Units::metres));
        did(fmt::format("read {} vertices, {} faces", mesh.positions.size(), mesh.triangles.size()));
        did(fmt::format("welded {} vertices", weld(mesh)));
    }
    tell(progress, recipe, "cleaning the surface", 0.3);
    did(fmt::format("dropped {} collapsed or double faces", drop_collapsed(mesh)));
    if (recipe.largest) did(fmt::format("dropped {} smaller parts", keep_largest(mesh)));
    if (const int passes = recipe.smooth.value_or(recipe.volume.empty() ? 0 : 10); passes > 0) {
        smooth(mesh, passes);
        did(fmt::format("smoothed {} times", passes));
    }
    if (recipe.faces > 0) {
        did(fmt::format("simplified away {} faces", decimate(mesh, std::size_t(recipe.faces))));
        if (recipe.largest) keep_largest(mesh);  // without the crumbs that simplifying may break off
    }
    if (mesh.triangles.empty())
        throw Error("no face is left", recipe.volume.empty() ? recipe.surface : recipe.volume,
                    "ask for more faces");
    if (volume(mesh) < 0) {
        for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
        did("turned it right way out");
    }
    rotate(mesh, recipe.rotate);
    for (vec3& p : mesh.positions) p += recipe.move;
    compute_normals(mesh);
    const Soundness sound = soundness(mesh);
    did(fmt::format("{} vertices, {} faces, {} parts, {} open edges, {} bad edges", mesh.positions.size(),
                    mesh.triangles.size(), sound.parts, sound.open_edges, sound.bad_edges));
    return surface;
}

std::string size_warning(const Mesh& surface) {
    const vec3 size = bounds(surface).size();
    const float longest = std::max({size.x, size.y, size.z});
    if (longest > 10) return fmt::format("it is {:.3g} m long; is the unit right?", longest);
    if (longest < 0.001f) return fmt::format("it is {:.3g} m long; is the unit right?", longest);
    return {};
}

Models build(const Scene& scene, const Progress& progress) {
    Models result;
    for (const BodyRecipe& recipe : scene.bodies)
        result.models.push_back(build_one(recipe, scene, result.notes, progress));
    return result;
}

}  // namespace palpate
