#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/base/clock.h"
#include "palpate/mesh/read.h"
#include "palpate/mesh/write.h"
#include "palpate/scene/build.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace {

using namespace palpate;

struct Arguments {
    std::string in, out, units;
    std::vector<float> rotate;
    BodyRecipe recipe;
};

void import_file(Arguments& arguments) {
    const double start = now();
    BodyRecipe& recipe = arguments.recipe;
    recipe.name = std::filesystem::path(arguments.in).filename().string();
    const std::string file = std::filesystem::absolute(arguments.in).string();
    (is_volume(arguments.in) ? recipe.volume : recipe.surface) = file;
    if (!recipe.volume.empty() && !recipe.iso)
        throw CLI::ValidationError("--iso", "a volume needs the value at its surface, such as --iso 60.5");
    if (!arguments.units.empty()) {
        recipe.units = value_of<Units>(arguments.units);
        if (!recipe.units) throw CLI::ValidationError("--units", "choose from " + all_names<Units>());
    }
    if (arguments.rotate.size() == 3)
        recipe.rotate = vec3(arguments.rotate[0], arguments.rotate[1], arguments.rotate[2]);

    check_mesh_name(arguments.out);
    const CleanSurface surface = make_surface(recipe, {}, terminal_progress());
    write_mesh(surface.mesh, arguments.out);
    end_progress();
    for (const std::string& step : surface.steps) fmt::print("  {}\n", step);
    if (const std::string warning = size_warning(surface.mesh); !warning.empty())
        fmt::print("  note: {}\n", warning);
    fmt::print("wrote {} in {:.1f} s\n", arguments.out, now() - start);
}

}  // namespace

void add_import(CLI::App& app) {
    auto arguments = std::make_shared<Arguments>();
    BodyRecipe& recipe = arguments->recipe;
    recipe.largest = false;
    CLI::App* command = app.add_subcommand("import", "Make a clean surface of a mesh or a volume");
    command->add_option("in", arguments->in, "a mesh (PLY, OBJ) or a volume (NIfTI)")->required();
    command->add_option("-o,--out", arguments->out, "PLY or OBJ, in metres")->required();
    command->add_option("--iso", recipe.iso, "value at a volume's surface; half-integer for integer volumes");
    command->add_flag("--largest", recipe.largest, "keep only the largest connected part");
    command->add_option("--smooth", recipe.smooth, "passes of smoothing [10 for a volume, 0 for a mesh]")
        ->check(CLI::Range(0, 1000));
    command->add_option("--faces", recipe.faces, "simplify to about so many faces")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--units", arguments->units,
                        "of the file: m, cm, mm, um [mm for a volume, m for a mesh]");
    command->add_option("--rotate", arguments->rotate, "degrees about x, y, z")
        ->expected(3)
        ->check(CLI::Range(-360.0, 360.0));
    command->callback([arguments] { import_file(*arguments); });
}
