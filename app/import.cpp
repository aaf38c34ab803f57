#include "app/choice.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/base/clock.h"
#include "palpate/base/files.h"
#include "palpate/base/memory.h"
#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "palpate/scene/surface.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <memory>

namespace {

using namespace palpate;

struct ImportArguments {
    std::string in, out, units, solid, report;
    std::vector<float> rotate;
    BodyRecipe recipe;
};

void write_report(const ImportArguments& arguments, const CleanSurface& surface, double seconds) {
    const vec3 size = bounds(surface.mesh).size();
    const nlohmann::ordered_json report = {{"in", arguments.in},
                                           {"out", arguments.out},
                                           {"vertices", surface.mesh.positions.size()},
                                           {"faces", surface.mesh.triangles.size()},
                                           {"size_m", {size.x, size.y, size.z}},
                                           {"volume_m3", volume(surface.mesh)},
                                           {"steps", surface.steps},
                                           {"notes", surface.notes},
                                           {"seconds", seconds},
                                           {"peak_memory_bytes", peak_memory()}};
    write_text(arguments.report, report.dump(2) + "\n");
}

void import_file(ImportArguments& arguments) {
    const double start = now();
    BodyRecipe& recipe = arguments.recipe;
    recipe.name = std::filesystem::path(arguments.in).filename().string();
    const std::string file = std::filesystem::absolute(arguments.in).string();
    (is_volume(arguments.in) ? recipe.volume : recipe.surface) = file;
    if (recipe.volume.empty() && recipe.iso)
        throw CLI::ValidationError("--iso", "only a volume has an isovalue");
    if (recipe.size > 0 && !arguments.units.empty())
        throw CLI::ValidationError("--size", "cannot be combined with --units");
    recipe.units = chosen<Units>("--units", arguments.units);
    recipe.repair.solid = chosen<SolidBy>("--solid", arguments.solid).value_or(SolidBy::walls);
    if (arguments.rotate.size() == 3)
        recipe.rotate = vec3(arguments.rotate[0], arguments.rotate[1], arguments.rotate[2]);

    check_mesh_name(arguments.out);
    check_output(arguments.out);
    check_output(arguments.report, ".json");
    for (const std::filesystem::path output : {arguments.out, arguments.report})
        check_not_input(output, std::array{std::filesystem::path(arguments.in)});
    const CleanSurface surface = make_surface(recipe, {}, terminal_progress());
    write_mesh(surface.mesh, arguments.out);
    end_progress();
    const double seconds = now() - start;
    if (!arguments.report.empty()) write_report(arguments, surface, seconds);
    for (const std::string& step : surface.steps) fmt::print("  {}\n", step);
    for (const std::string& note : surface.notes) fmt::print("  note: {}\n", note);
    fmt::print("wrote {} in {:.1f} s, peak memory {} MB\n", arguments.out, seconds, peak_memory() >> 20);
}

}  // namespace

void add_import(CLI::App& app) {
    auto arguments = std::make_shared<ImportArguments>();
    BodyRecipe& recipe = arguments->recipe;
    recipe.largest = false;
    CLI::App* command = app.add_subcommand("import", "Make a clean surface of a mesh or a volume");
    command->add_option("in", arguments->in, "a mesh, a volume, or a folder with a DICOM series")->required();
    command->add_option("-o,--out", arguments->out, "the surface: PLY, OBJ, STL, GLB or glTF, in metres")
        ->required();
    command
        ->add_option(
            "--iso", recipe.iso,
            "isovalue of a volume's surface, half-integer for integer volumes [suggested by its histogram]")
        ->check(number_that("a number", [](double) { return true; }));
    command->add_flag(
        "--largest", recipe.largest,
        "keep only the largest part by volume; parts that touch, overlap or lie in each other count as one");
    command->add_option("--smooth", recipe.smooth, "passes of smoothing [10 for a volume, 0 for a mesh]")
        ->check(from_to(0, 1000));
    command->add_option("--faces", recipe.faces, "simplify to about so many faces")->check(zero_or_more());
    command->add_option("--units", arguments->units,
                        "of the file: m, cm, mm, um [what it states; else mm for a volume, m for a mesh]");
    command->add_option("--size", recipe.size, "m: in place of --units, the length of its longest side")
        ->check(above_zero());
    command
        ->add_option("--weld", recipe.repair.weld,
                     "m: join vertices at most this far apart [coincident ones]")
        ->check(zero_or_more());
    command
        ->add_option("--specks", recipe.repair.specks,
                     "drop parts shorter than this fraction of the longest; 0 keeps all [0.01]")
        ->check(from_to(0, 0.999));
    command->add_flag("--sheet", recipe.sheet, "it is cloth: leave it open");
    command->add_option(
        "--solid", arguments->solid,
        "how it becomes a solid: walls (repaired, or rebuilt by voxels if that fails) or voxels [walls]");
    command
        ->add_option("--voxel", recipe.repair.voxel,
                     "m: the size of those voxels [1/300 of its longest side]")
        ->check(zero_or_more());
    command->add_option("--report", arguments->report, "write what was done as JSON");
    command->add_option("--rotate", arguments->rotate, "degrees about x, y, z")
        ->expected(3)
        ->check(from_to(-360, 360));
    command->callback([arguments] { import_file(*arguments); });
}
