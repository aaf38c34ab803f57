#include "palpate/mesh/repair.h"

#include "palpate/base/error.h"
#include "palpate/mesh/intersections.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/remake.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace palpate {
namespace {

// The steps so far. A repeated step adds to its count.
struct Steps {
    std::vector<Repair> done;
    double dropped = 0;  // m³, in total

    Repair& add(const std::string& what, std::size_t count) {
        auto at =
            std::find_if(done.begin(), done.end(), [&](const Repair& step) { return step.what == what; });
        if (at == done.end()) at = done.insert(at, {what, 0});
        at->count += count;
        return *at;
    }
    void add(const std::string& what, const Dropped& removed) {
        if (removed.parts > 0) add(what, removed.parts).volume += removed.volume;
        if (removed.crowded > 0)
            add("faces too crowded to be searched for parts that touch", 0).count = removed.crowded;
        dropped += removed.volume;
    }
    // For a share of the surface's area.
    void add(const std::string& what, std::size_t count, double share) {
        if (count > 0) add(what, count).share += share;
    }

    // The result, for a solid of this volume, in a unit of this many metres.
    std::vector<Repair> of(double volume, double unit) && {
        std::erase_if(done, [](const Repair& step) { return step.count == 0; });
        for (Repair& step : done) {
            if (step.volume <= 0) continue;
            step.share = step.volume / (volume + dropped);
            step.volume *= unit * unit * unit;
        }
        return std::move(done);
    }
};

// Scales a very large or very small mesh to about one metre, and back: by a power of two, which is exact. So
// lengths may be squared in between.
class UnitScale {
 public:
    explicit UnitScale(Mesh& mesh) : mesh_(mesh) {
        float farthest = 0;
        for (vec3 p : mesh.positions)
            farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const int power = farthest > 0 ? std::ilogb(farthest) : 0;
        if (std::abs(power) <= 10) return;
        power_ = power;
        scale(-power_);
    }
    ~UnitScale() { scale(power_); }
    UnitScale(const UnitScale&) = delete;
    UnitScale& operator=(const UnitScale&) = delete;

    float length(float metres) const { return std::ldexp(metres, -power_); }
    double unit() const { return std::ldexp(1.0, power_); }  // m

 private:
    void scale(int power) {
        if (power == 0) return;
        for (vec3& p : mesh_.positions)
            p = {std::ldexp(p.x, power), std::ldexp(p.y, power), std::ldexp(p.z, power)};
    }

    Mesh& mesh_;
    int power_ = 0;
};

void check_finite(const Mesh& mesh, const std::string& name) {
    for (vec3 p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw Error("a position that is not finite", name, "correct it in the program that made it");
}

bool is_closed(const Mesh& mesh) {
    bool closed = true;
    for_each_edge(Corners(mesh), [&](Index low, std::span<const Side> sides) {
        closed &= sides.size() == 2 && sides[0].up != sides[1].up && sides[0].other != low;
    });
    return closed;
}

bool is_open(const Mesh& mesh) {
    bool open = false;
    for_each_edge(Corners(mesh), [&](Index, std::span<const Side> sides) { open |= sides.size() == 1; });
    return open;
}

float longest_side(const Mesh& mesh) {
    const vec3 size = bounds(mesh).size();
    return std::max({size.x, size.y, size.z});
}

// The area of the faces from `first` on.
double area_from(const Mesh& mesh, std::size_t first) {
    double area = 0;
    for (std::size_t face = first; face < mesh.triangles.size(); ++face)
        area += face_area(mesh, mesh.triangles[face]);
    return area;
}

// If few faces lie back to back, both are dropped. If most do, the surface was written two-sided, and one of
// each pair is kept.
void drop_backs(Mesh& mesh, Steps& steps) {
    Mesh without{mesh.positions, {}, mesh.triangles};
    const std::size_t flaps = drop_flaps(without);
    if (2 * flaps < mesh.triangles.size()) {
        mesh.triangles = std::move(without.triangles);
        steps.add("faces dropped that lay back to back", flaps);
    }
    steps.add("copies of faces dropped", drop_copies(mesh));
}

// Drops what is duplicate, degenerate or too small.
void clean(Mesh& mesh, const RepairSettings& settings, float tolerance, Steps& steps) {
    constexpr float seam = 1e-5f;  // of the longest side
    const bool open = is_open(mesh);
    std::size_t welded = tolerance > 0 || open ? weld(mesh, tolerance) : 0;
    std::size_t collapsed = drop_collapsed(mesh);
    if (tolerance == 0 && (welded + collapsed > 0 ? is_open(mesh) : open)) {
        welded += weld_border(mesh, seam * longest_side(mesh));
        collapsed += drop_collapsed(mesh);
    }
    steps.add("vertices welded", welded);
    steps.add("collapsed or double faces dropped", collapsed);
    drop_backs(mesh, steps);
    const double area = area_from(mesh, 0);
    auto dropped = [&](const std::string& what, const Dropped& removed) {
        if (settings.sheet)
            steps.add(what, removed.parts, removed.area / area);
        else
            steps.add(what, removed);
    };
    dropped("specks dropped", drop_specks(mesh, settings.specks));
    steps.add("faces without an area removed", drop_flat_faces(mesh));
    steps.add("faces turned to agree with their neighbours", turn_faces(mesh));
    if (settings.largest)  // first, so that the dropped parts cannot spoil the mending of the rest
        dropped("smaller parts dropped", settings.sheet ? keep_largest_sheet(mesh) : keep_largest(mesh));
    if (settings.cavities > 0) {
        const Dropped filled = fill_cavities(mesh, settings.cavities);
        steps.add("small cavities filled", filled.parts).volume += filled.volume;
    }
}

// Drops parts that enclose almost nothing. `closing`: the first face that was added to close holes. A part
// that needed a large lid and still encloses little was meant as a sheet.
void drop_sheets(Mesh& mesh, std::size_t closing, Steps& steps) {
    const Parts part = parts(mesh);
    const std::vector<double> area = areas(mesh, part);
    std::vector<double> lid(part.count);
    for (std::size_t face = closing; face < mesh.triangles.size(); ++face)
        lid[part.of[face]] += face_area(mesh, mesh.triangles[face]);
    const std::vector<double> volume = volumes(mesh, part);
    std::vector<char> keep;
    for (Index i = 0; i < part.count; ++i) {
        const double roundness = std::abs(volume[i]) / std::pow(area[i], 1.5);  // 0.094 for a ball
        keep.push_back(roundness > (lid[i] > 0.25 * area[i] ? 1e-3 : 1e-6));
    }
    const double all = area_from(mesh, 0);
    const Dropped removed = keep_parts(mesh, part, keep);
    steps.add("sheets dropped that enclose nothing", removed.parts, removed.area / all);
}

Error no_inside(const RepairSettings& settings) {
    return Error("no inside", settings.name, "give it a thickness, or use it as a cloth (sheet = true)");
}

// Whether a non-orientable part is a Möbius band and not a Klein bottle with a hole: its border is long for
// its area.
bool is_one_sided_sheet(const Mesh& mesh, std::size_t one_sided) {
    if (one_sided == 0) return false;
    const double border = soundness(mesh).longest_hole;
    const double disc = border * border / (4 * std::numbers::pi);  // the area of one with this border
    return disc > 0.25 * area_from(mesh, 0);
}

// Keeps those closed parts that separate inside from outside and are large enough. Returns how many lie
// partly inside others.
std::size_t keep_sound_parts(Mesh& mesh, Arrangement& arrangement, const RepairSettings& settings,
                             Steps& steps) {
    steps.add("faces without an area removed", drop_flat_faces(mesh));
    drop_sheets(mesh, mesh.triangles.size(), steps);
    steps.add("specks dropped", drop_specks(mesh, settings.specks));
    arrangement.forget();
    if (settings.largest) steps.add("smaller parts dropped", keep_largest(mesh, arrangement));
    steps.add("parts turned outward", turn_parts(mesh, arrangement));
    const Nested nested = drop_nested(mesh, arrangement);
    steps.add("parts dropped that lay inside another", nested.dropped);
    drop_unused(mesh);
    return nested.dropped == 0 ? nested.crossing : nesting(mesh).crossing;
}

// Makes a solid of the mesh's own faces. Returns why that failed; empty if it succeeded.
std::string repair_walls(Mesh& mesh, std::size_t one_sided, const RepairSettings& settings, Steps& steps) {
    if (one_sided > 0)
        return fmt::format("{} part{} one side only", one_sided, one_sided == 1 ? " has" : "s have");
    const std::size_t closing = mesh.triangles.size();
    const std::size_t holes = close_holes(mesh);
    steps.add("holes closed", holes, area_from(mesh, closing) / area_from(mesh, 0));
    drop_sheets(mesh, closing, steps);
    steps.add("faces dropped that lay back to back", drop_flaps(mesh));
    steps.add("vertices added to separate touching sheets", separate_sheets(mesh));
    Arrangement arrangement(mesh);
    std::size_t crossing = keep_sound_parts(mesh, arrangement, settings, steps);
    const Intersections cuts = intersections(arrangement.tree());
    if (!cuts.all) steps.add("faces too crowded to be searched for cuts", mesh.triangles.size());
    if (!cuts.faces.empty()) {
        const double before = volume(mesh);
        const std::size_t mended = mend_intersections(mesh, cuts);
        if (mended == 0)
            return fmt::format("{}{} pairs of faces cut through each other", cuts.all ? "" : "over ",
                               cuts.faces.size());
        steps.add("faces replaced that cut through each other", mended).volume +=
            std::abs(volume(mesh) - before);
        crossing = keep_sound_parts(mesh, arrangement, settings, steps);
    }
    if (crossing > 0) return fmt::format("{} parts lie partly inside others", crossing);
    if (!is_closed(mesh)) return "some of its holes cannot be closed";
    if (!(volume(mesh) > 0)) return "its walls enclose nothing";
    return {};
}

// Decimates a voxel remesh to about the original number of faces, or to as few as are possible without
// self-intersections; and drops the crumbs that break off at narrow gaps and necks.
void simplify(Mesh& solid, std::size_t faces) {
    constexpr std::size_t fewest = 2000;
    const std::size_t most = parts(solid).count;
    for (std::size_t wanted = std::max(faces, fewest);; wanted *= 2) {
        Mesh simple = solid;
        decimate(simple, wanted);
        separate_sheets(simple);
        drop_crumbs(simple, most);
        const Intersections cuts = intersections(simple);
        if (cuts.faces.empty() || mend_intersections(simple, cuts) > 0 || wanted > solid.triangles.size()) {
            drop_crumbs(simple, most);
            solid = std::move(simple);
            return;
        }
    }
}

void make_by_voxels(Mesh& mesh, const RepairSettings& settings, float voxel, const std::string& why,
                    const Progress& progress, Steps& steps) {
    steps.add("parts turned outward", turn_parts(mesh));
    Remade made = remake(mesh, voxel, settings.name, progress);
    Mesh& solid = made.solid;
    steps.add("hollows filled that no wall bounds", made.hollows.parts).volume = made.hollows.volume;
    steps.add("fragments dropped that voxels left", made.bits);
    steps.add("faces lost where walls are thinner than a voxel", made.thin_faces, made.thin);
    Steps own;  // of the voxel remesh; only what these drop is reported
    Arrangement arrangement(solid);
    keep_sound_parts(solid, arrangement, settings, own);
    const double before = volume(solid);
    simplify(solid, mesh.triangles.size());
    keep_sound_parts(solid, arrangement, settings, own);
    for (const Repair& step : own.done)
        if (step.what == "specks dropped" || step.what == "smaller parts dropped")
            steps.add(step.what, Dropped{step.count, step.volume});
    if (!is_closed(solid) || !(volume(solid) > 0)) throw no_inside(settings);
    mesh = std::move(solid);
    steps.add("faces made by voxels, because " + why, mesh.triangles.size()).volume =
        std::abs(volume(mesh) - before);
}

}  // namespace

std::span<const Named<SolidBy>> names(SolidBy) {
    static constexpr Named<SolidBy> all[] = {{SolidBy::walls, "walls"}, {SolidBy::voxels, "voxels"}};
    return all;
}

std::string in_words(const Repair& step) {
    std::string words = fmt::format("{}: {}", step.what, step.count);
    if (step.volume > 0)
        words += fmt::format(" ({:.2g} % of the volume, {:.3g} ml)", 100 * step.share, 1e6 * step.volume);
    else if (step.share > 0)
        words += fmt::format(" ({:.2g} % of the area)", 100 * step.share);
    return words;
}

std::vector<Repair> repair(Mesh& mesh, const RepairSettings& settings, const Progress& progress) {
    check_finite(mesh, settings.name);
    const UnitScale unit_scale(mesh);
    auto tell = [&](std::string_view doing, double done) {
        if (progress) progress(doing, done);
    };
    Steps steps;
    tell("cleaning the mesh", 0);
    clean(mesh, settings, unit_scale.length(settings.weld), steps);
    if (settings.sheet) {
        if (mesh.triangles.empty()) throw Error("no face with an area", settings.name, "look at the file");
        return std::move(steps).of(0, unit_scale.unit());
    }
    const std::size_t one_sided = one_sided_parts(mesh);
    if (is_one_sided_sheet(mesh, one_sided)) throw no_inside(settings);
    std::string why = "as requested";
    if (settings.solid == SolidBy::walls) {
        tell("repairing the walls", 0.2);
        Mesh walls = mesh;
        Steps more = steps;
        why = repair_walls(walls, one_sided, settings, more);
        if (why.empty()) {
            mesh = std::move(walls);
            return std::move(more).of(volume(mesh), unit_scale.unit());
        }
    }
    tell("remeshing by voxels", 0.5);
    make_by_voxels(mesh, settings, unit_scale.length(settings.voxel), why, progress, steps);
    return std::move(steps).of(volume(mesh), unit_scale.unit());
}

}  // namespace palpate
