#include "app/choice.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/palpate.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace {

using namespace palpate;
using Json = nlohmann::ordered_json;

Json list(vec3 v) { return {v.x, v.y, v.z}; }

// A kind of defect: its key in the output, how many there are, and its name in the verdict.
struct Defect {
    const char* key;
    std::size_t count;
    const char* name;  // null if a mesh that has it may be a solid
};

std::vector<Defect> defects(const Soundness& sound, const Nesting& nested, std::size_t cuts) {
    return {{"open_edges", sound.open_edges, "open edges"},
            {"holes", sound.holes, nullptr},
            {"bad_edges", sound.bad_edges, nullptr},
            {"crowded_edges", sound.crowded_edges, "edges with more than two faces"},
            {"clashing_edges", sound.clashing_edges, "edges whose faces are oriented against each other"},
            {"shared_vertices", sound.shared_vertices, nullptr},
            {"unused_vertices", sound.unused_vertices, nullptr},
            {"copied_faces", sound.copied_faces, "duplicate faces"},
            {"collapsed_faces", sound.collapsed_faces, "collapsed faces"},
            {"flat_faces", sound.flat_faces, nullptr},
            {"one_sided_parts", sound.one_sided_parts, "parts with one side only"},
            {"inside_out_parts", nested.inside_out, "parts inside out"},
            {"nested_parts", nested.redundant, "parts inside others"},
            {"cavities", nested.cavities, nullptr},
            {"specks", sound.specks, nullptr},
            {"cutting_faces", cuts, "pairs of faces that cut through each other"}};
}

std::string verdict(const std::vector<Defect>& all, double volume, bool searched) {
    std::string found;
    for (const Defect& one : all)
        if (one.name && one.count > 0)
            found += fmt::format("{}{} {}", found.empty() ? "" : ", ", one.count, one.name);
    if (found.empty() && volume > 0)
        return searched ? "a solid" : "a solid, but its faces are too crowded to be searched for cuts";
    if (found.empty()) found = "it encloses nothing";
    return "not a solid: " + found + "; palpate import repairs what it can";
}

Json describe(const Mesh& mesh) {
    const Soundness sound = soundness(mesh);
    const Bounds box = bounds(mesh);
    Json about = {{"kind", "mesh"},
                  {"vertices", mesh.positions.size()},
                  {"faces", mesh.triangles.size()},
                  {"parts", sound.parts},
                  {"size_m", list(box.size())},
                  {"low_m", list(box.empty() ? vec3(0) : box.low)},
                  {"high_m", list(box.empty() ? vec3(0) : box.high)},
                  {"volume_m3", volume(mesh)},
                  {"euler", sound.euler}};
    const Intersections cuts = intersections(mesh);
    const std::vector<Defect> all = defects(sound, nesting(mesh), cuts.faces.size());
    for (const Defect& one : all) about[one.key] = one.count;
    about["longest_hole_m"] = sound.longest_hole;
    about["verdict"] = verdict(all, volume(mesh), cuts.all);
    return about;
}

Json describe(Volume volume) {
    const Histogram values = histogram(volume, 64);
    const mat3 d = volume.direction;
    Json about = {{"kind", "volume"},
                  {"voxels", {volume.dims.x, volume.dims.y, volume.dims.z}},
                  {"spacing_m", list(volume.spacing)},
                  {"size_m", list(volume.spacing * vec3(volume.dims))},
                  {"origin_m", list(volume.origin)},
                  {"axes", {list(d[0]), list(d[1]), list(d[2])}},
                  {"lowest_value", values.lowest},
                  {"highest_value", values.highest},
                  {"whole_numbers", values.whole},
                  {"suggested_iso", nullptr},
                  {"histogram", {{"from", values.from}, {"to", values.to}, {"counts", values.counts}}}};
    if (const auto iso = suggested_iso(histogram(volume))) about["suggested_iso"] = *iso;
    constexpr double percents[] = {1, 25, 50, 75, 99};
    const std::vector<float> at = percentiles(std::move(volume.values), percents);
    for (std::size_t i = 0; i < at.size(); ++i) about["percentiles"][fmt::format("{}", percents[i])] = at[i];
    return about;
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
    const auto unit = chosen<Units>("--units", units);
    if (is_scene(name)) return describe(read_scene(name));
    std::vector<std::string> notes;
    if (is_volume(name)) {
        Json about = describe(read_volume(name, unit, &notes));
        about["notes"] = notes;
        return about;
    }
    Mesh mesh = read_mesh(name, unit, &notes);
    // Many files write a vertex once for each of its faces. But in a mesh that is closed already, coincident
    // vertices separate parts that would otherwise touch.
    if (!soundness(mesh).closed()) weld(mesh);
    Json about = describe(mesh);
    if (const std::string warning = size_warning(mesh); !warning.empty()) notes.push_back(warning);
    about["notes"] = notes;
    return about;
}

// A bar for each bin, as long as the square root of its count, so that rare values show beside air.
void print_histogram(const Json& histogram) {
    const auto counts = histogram["counts"].get<std::vector<double>>();
    const double from = histogram["from"], to = histogram["to"];
    constexpr std::size_t rows = 16;
    const std::size_t each = (counts.size() + rows - 1) / rows;
    std::vector<double> sums((counts.size() + each - 1) / each);
    for (std::size_t i = 0; i < counts.size(); ++i) sums[i / each] += counts[i];
    const double most = *std::max_element(sums.begin(), sums.end());
    fmt::print("  voxels by value (bars as long as the square root of the count):\n");
    for (std::size_t row = 0; row < sums.size(); ++row) {
        const double value = from + (to - from) * double(row * each) / double(counts.size());
        const auto length = std::size_t(std::ceil(50 * std::sqrt(sums[row] / most)));
        fmt::print("  {:>10.5g}  {:<50}  {}\n", value, std::string(length, '#'),
                   grouped((long long)sums[row]));
    }
}

// A value as text for people: strings without quotes, lists with spaces.
std::string plain(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (value.is_array() && !value.empty() && !value[0].is_object()) {
        std::string text;
        const char* between = value[0].is_number() ? " x " : value[0].is_array() ? ", " : "; ";
        for (const Json& one : value) text += (text.empty() ? "" : between) + plain(one);
        return text;
    }
    return value.dump();
}

// Zero counts and empty lists, which are left out of the text.
bool is_nothing(const Json& value) { return value == 0 || (value.is_array() && value.empty()); }

}  // namespace

void add_info(CLI::App& app) {
    struct Arguments {
        std::string file, units;
        bool json = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("info", "Describe a mesh, a volume or a scene, in metres");
    command->add_option("file", arguments->file, "a mesh, a volume, a scene, or a shipped scene's name")
        ->required();
    command->add_option("--units", arguments->units,
                        "of the file: m, cm, mm, um [what it states; else mm for a volume, m for a mesh]");
    command->add_flag("--json", arguments->json, "as JSON");
    command->callback([arguments] {
        const Json about = look_at(arguments->file, arguments->units);
        if (arguments->json) {
            fmt::print("{}\n", about.dump(2));
            return;
        }
        std::vector<std::pair<std::string, std::string>> rows;
        for (const auto& [key, value] : about.items())
            if (key != "histogram" && !is_nothing(value)) rows.emplace_back(key, plain(value));
        print_table(rows);
        if (about.contains("histogram")) print_histogram(about["histogram"]);
    });
}
