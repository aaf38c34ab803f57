#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/palpate.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace {

using namespace palpate;
using Json = nlohmann::ordered_json;

Json list(vec3 v) { return {v.x, v.y, v.z}; }

Json describe(const Mesh& mesh) {
    const Soundness sound = soundness(mesh);
    const Bounds box = bounds(mesh);
    return {{"kind", "mesh"},
            {"vertices", mesh.positions.size()},
            {"faces", mesh.triangles.size()},
            {"parts", sound.parts},
            {"open_edges", sound.open_edges},
            {"bad_edges", sound.bad_edges},
            {"size_m", list(box.size())},
            {"low_m", list(box.empty() ? vec3(0) : box.low)},
            {"high_m", list(box.empty() ? vec3(0) : box.high)},
            {"volume_m3", volume(mesh)}};
}

Json describe(const Volume& volume) {
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    return {{"kind", "volume"},
            {"voxels", {volume.dims.x, volume.dims.y, volume.dims.z}},
            {"spacing_m", list(volume.spacing)},
            {"size_m", list(volume.spacing * vec3(volume.dims))},
            {"origin_m", list(volume.origin)},
            {"lowest_value", *low},
            {"highest_value", *high}};
}

Json describe(const Scene& scene) {
    Json bodies = Json::array(), tools = Json::array();
    for (const BodyRecipe& body : scene.bodies)
        bodies.push_back({{"name", body.name},
                          {"from", body.dims             ? "dims"
                                   : body.cloth          ? "cloth"
                                   : body.volume.empty() ? body.surface
                                                         : body.volume},
                          {"mapping", name_of(body.mapping)}});
    for (const ToolRecipe& tool : scene.tools)
        tools.push_back({{"name", tool.name}, {"kind", name_of(tool.kind)}});
    return {{"kind", "scene"},
            {"backend", name_of(scene.simulation.backend)},
            {"integrator", name_of(scene.simulation.integrator)},
            {"duration_s", scene.duration},
            {"bodies", bodies},
            {"colliders", scene.colliders.size()},
            {"moves", scene.moves.size()},
            {"tools", tools}};
}

bool is_scene(const std::string& name) {
    const auto& shipped = shipped_scenes();
    return name.ends_with(".toml") ||
           std::any_of(shipped.begin(), shipped.end(), [&](const ShippedScene& s) { return s.name == name; });
}

Json look_at(const std::string& name, const std::string& units) {
    const auto unit = value_of<Units>(units);
    if (!units.empty() && !unit) throw CLI::ValidationError("--units", "choose from " + all_names<Units>());
    if (is_scene(name)) return describe(read_scene(name));
    if (is_volume(name)) return describe(read_volume(name, unit.value_or(Units::millimetres)));
    Mesh mesh = read_mesh(name, unit.value_or(Units::metres));
    weld(mesh);  // many files write a vertex once for each of its faces
    Json about = describe(mesh);
    if (const std::string warning = size_warning(mesh); !warning.empty()) about["note"] = warning;
    return about;
}

// A value as a person reads it: texts without quotes, lists with spaces.
std::string plain(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (value.is_array() && !value.empty() && value[0].is_number()) {
        std::string text;
        for (const Json& one : value) text += (text.empty() ? "" : " x ") + plain(one);
        return text;
    }
    return value.dump();
}

}  // namespace

void add_info(CLI::App& app) {
    struct Arguments {
        std::string file, units;
        bool json = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("info", "Say what a mesh, a volume or a scene holds, in metres");
    command->add_option("file", arguments->file, "a mesh, a volume, a scene, or a shipped scene's name")
        ->required();
    command->add_option("--units", arguments->units,
                        "of the file: m, cm, mm, um [mm for a volume, m for a mesh]");
    command->add_flag("--json", arguments->json, "as JSON");
    command->callback([arguments] {
        const Json about = look_at(arguments->file, arguments->units);
        if (arguments->json) {
            fmt::print("{}\n", about.dump(2));
            return;
        }
        std::vector<std::pair<std::string, std::string>> rows;
        for (const auto& [key, value] : about.items()) rows.emplace_back(key, plain(value));
        print_table(rows);
    });
}
