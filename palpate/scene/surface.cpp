#include "palpate/scene/surface.h"

#include "palpate/base/error.h"
#include "palpate/files/read.h"
#include "palpate/mesh/histogram.h"
#include "palpate/mesh/intersections.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/tree.h"
#include "palpate/mesh/winding_number.h"
#include "palpate/voxels/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// A surface while it is made, and its report.
struct Work {
    const BodyRecipe& recipe;
    const std::filesystem::path& folder;
    const Progress& progress;
    CleanSurface result{};

    void tell(const std::string& doing, double fraction) const {
        if (progress) progress(recipe.name + ": " + doing, fraction);
    }
    void did(const std::string& step) { result.steps.push_back(step); }
    // A step that changed the surface by more than a hundredth is a note as well.
    void did(const Repair& step) {
        did(in_words(step));
        if (step.share > 0.01) result.notes.push_back(in_words(step));
    }
};

const std::string& file_of(const BodyRecipe& recipe) {
    return recipe.volume.empty() ? recipe.surface : recipe.volume;
}

// A surface that need not enclose a volume: cloth, or a surface in a cage.
bool may_be_open(const BodyRecipe& recipe) { return recipe.sheet || recipe.cage; }

float suggested(const Volume& volume, std::vector<std::string>& notes) {
    const auto iso = suggested_iso(histogram(volume));
    if (!iso) throw Error("all values are equal", volume.name, "give a volume that holds something");
    notes.push_back(
        fmt::format("its surface is taken at {}, as its values suggest; iso says otherwise", *iso));
    return *iso;
}

Mesh from_volume(Work& work) {
    const BodyRecipe& recipe = work.recipe;
    const Volume volume =
        read_volume(find_data(recipe.volume, work.folder), recipe.units, &work.result.notes);
    work.tell("extracting the isosurface", 0.1);
    const float iso = recipe.iso ? *recipe.iso : suggested(volume, work.result.notes);
    Mesh mesh = isosurface(volume, iso);
    work.did(fmt::format("surface at {} of {} x {} x {} voxels: {} faces", iso, volume.dims.x, volume.dims.y,
                         volume.dims.z, mesh.triangles.size()));
    return mesh;
}

Mesh from_file(Work& work) {
    const BodyRecipe& recipe = work.recipe;
    Mesh mesh = read_mesh(find_data(recipe.surface, work.folder), recipe.units, &work.result.notes);
    work.did(fmt::format("read {} vertices, {} faces", mesh.positions.size(), mesh.triangles.size()));
    return mesh;
}

// The factor by which `size` scales the mesh in its present state; rotating it and dropping specks may change
// that a little.
float scale_of(const Mesh& mesh, const BodyRecipe& recipe) {
    const vec3 sides = bounds(mesh).size();
    return recipe.size > 0 ? recipe.size / std::max({sides.x, sides.y, sides.z}) : 1;
}

void mend(Mesh& mesh, Work& work) {
    const BodyRecipe& recipe = work.recipe;
    RepairSettings settings = recipe.repair;
    const float wanted = scale_of(mesh, recipe), scale = wanted > 0 && std::isfinite(wanted) ? wanted : 1;
    const vec3 sides = bounds(mesh).size();
    const float longest = scale * std::max({sides.x, sides.y, sides.z});
    for (const auto& [key, length] : {std::pair{"weld", settings.weld}, {"voxel", settings.voxel}})
        if (longest > 0 && length > longest)
            throw Error(
                fmt::format("{} is {:.3g} m, and the whole surface is {:.3g} m long", key, length, longest),
                file_of(recipe), fmt::format("use a smaller {}", key));
    settings.weld /= scale;
    settings.voxel /= scale;
    settings.largest = recipe.largest;
    if (recipe.largest && !recipe.volume.empty()) settings.cavities = 0.001;
    settings.sheet = may_be_open(recipe);
    settings.name = file_of(recipe);
    const Progress tell = [&](std::string_view doing, double done) {
        work.tell(std::string(doing), 0.3 + 0.2 * done);
    };
    std::vector<Repair> steps = repair(mesh, settings, tell);
    const double unit = std::pow(double(scale_of(mesh, recipe)), 3);  // at its final size
    for (Repair& step : steps) {
        step.volume *= unit;
        work.did(step);
    }
}

// Which parts of a file are in the solid that was made from it: those with most of their faces inside or on
// it.
std::vector<char> parts_in(const Mesh& solid, const Mesh& mesh, const Parts& part) {
    constexpr std::size_t most_samples = 100;  // a part
    const vec3 size = bounds(solid).size();
    const float on = 0.005f * std::max({size.x, size.y, size.z});  // the accuracy of remeshing by voxels
    const Tree tree(solid);
    const WindingNumber winding(tree);
    const std::vector<std::vector<Index>> faces = faces_by(part.of, part.count);
    std::vector<char> in;
    for (const std::vector<Index>& own : faces) {
        const std::size_t samples = std::min(most_samples, own.size());
        std::size_t found = 0;
        for (std::size_t sample = 0; sample < samples; ++sample) {
            const uvec3 t = mesh.triangles[own[sample * own.size() / samples]];
            const vec3 p = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f;
            found += tree.distance(p, on) < on || winding.at(dvec3(p)) > 0.5;
        }
        in.push_back(2 * found > samples);
    }
    return in;
}

// The surface on which maps are drawn, because repair drops texture coordinates: the parts of the file's own
// surface that are in `solid`, oriented outwards.
Mesh textured(const Mesh& mesh, const Mesh& solid, const BodyRecipe& recipe) {
    if (mesh.uvs.empty())
        throw Error("no texture coordinates at all corners, for colour_map, normal_map or weave,",
                    file_of(recipe), "export it with them, or remove the maps");
    Mesh whole{mesh.positions, {}, {}};  // across the seams
    const std::vector<Index> first = first_in_place(mesh.positions);
    for (uvec3 t : mesh.triangles) whole.triangles.push_back({first[t.x], first[t.y], first[t.z]});
    const Parts part = parts(whole);
    const std::vector<char> kept =
        recipe.largest ? parts_in(solid, whole, part) : std::vector<char>(part.count, true);

    Mesh drawn;
    std::vector<Index> place(mesh.positions.size(), none);
    const bool inside_out = !may_be_open(recipe) && volume(mesh) < 0;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        if (!kept[part.of[face]]) continue;
        uvec3 t = mesh.triangles[face];
        if (inside_out) std::swap(t.y, t.z);
        for (int k = 0; k < 3; ++k) {
            Index& vertex = place[t[k]];
            if (vertex == none) {
                vertex = Index(drawn.positions.size());
                drawn.positions.push_back(mesh.positions[t[k]]);
                drawn.uvs.push_back(mesh.uvs[t[k]]);
            }
            t[k] = vertex;
        }
        drawn.triangles.push_back(t);
    }
    return drawn;
}

void simplify(Mesh& mesh, Work& work) {
    const BodyRecipe& recipe = work.recipe;
    const bool solid = !may_be_open(recipe);
    const double scale = std::pow(double(scale_of(mesh, recipe)), 3);
    // Reports a step, with its change of volume.
    double before = solid ? volume(mesh) : 0;
    auto did = [&](const std::string& what, std::size_t count) {
        if (count == 0) return;
        const double now = solid ? volume(mesh) : 0, change = std::abs(now - before);
        work.did(Repair{what, count, scale * change, before > 0 ? change / before : 0});
        before = now;
    };
    const int passes = recipe.smooth.value_or(recipe.volume.empty() ? 0 : 10);
    if (passes > 0) smooth(mesh, passes);
    did("passes of smoothing", std::size_t(std::max(passes, 0)));
    if (recipe.faces <= 0) return;
    const std::size_t most = parts(mesh).count, removed = decimate(mesh, std::size_t(recipe.faces));
    if (removed == 0) return;
    did("faces simplified away", removed);
    if (solid)
        did("faces replaced that cut through each other", mend_intersections(mesh, intersections(mesh)));
    // Pieces that decimation broke off.
    if (solid) did("smaller parts dropped", drop_crumbs(mesh, most).parts);
    if (!solid && recipe.largest) did("smaller parts dropped", keep_largest_sheet(mesh).parts);
    if (mesh.triangles.empty()) throw Error("no face is left", file_of(recipe), "ask for more faces");
}

// Places the mesh, and what is drawn in the same way.
void place(Mesh& mesh, Mesh& drawn, const BodyRecipe& recipe) {
    rotate(mesh, recipe.rotate);
    rotate(drawn, recipe.rotate);
    const float scale = scale_of(mesh, recipe);
    if (!std::isfinite(scale)) throw Error("a surface without a size", file_of(recipe), "give a mesh");
    for (Mesh* one : {&mesh, &drawn})
        for (vec3& p : one->positions) p *= scale;
    const vec3 way = recipe.move - (recipe.centre ? bounds(mesh).centre() : vec3(0));
    for (Mesh* one : {&mesh, &drawn})
        for (vec3& p : one->positions) p += way;
}

}  // namespace

CleanSurface make_surface(const BodyRecipe& recipe, const std::filesystem::path& folder,
                          const Progress& progress) {
    Work work{recipe, folder, progress};
    work.tell("reading", 0);
    Mesh mesh = recipe.volume.empty() ? from_file(work) : from_volume(work);
    const Mesh file = recipe.is_textured() ? mesh : Mesh();
    mend(mesh, work);
    Mesh drawn = recipe.is_textured() ? textured(file, mesh, recipe) : Mesh();
    work.tell("simplifying the surface", 0.5);
    simplify(mesh, work);
    place(mesh, drawn, recipe);
    compute_normals(mesh);
    compute_normals_by_place(drawn);
    const Soundness sound = soundness(mesh);
    work.did(fmt::format("{} vertices, {} faces, {} parts, {} open edges, {} bad edges",
                         mesh.positions.size(), mesh.triangles.size(), sound.parts, sound.open_edges,
                         sound.bad_edges));
    if (const std::string warning = size_warning(mesh); !warning.empty())
        work.result.notes.push_back(warning);
    work.result.mesh = std::move(mesh);
    work.result.drawn = std::move(drawn);
    return std::move(work.result);
}

std::string size_warning(const Mesh& surface) {
    const vec3 size = bounds(surface).size();
    const float longest = std::max({size.x, size.y, size.z});
    if (longest > 10) return fmt::format("it is {:.3g} m long; is the unit right?", longest);
    if (longest < 0.001f) return fmt::format("it is {:.3g} m long; is the unit right?", longest);
    return {};
}

}  // namespace palpate
