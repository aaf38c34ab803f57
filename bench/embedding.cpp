#include "bench/deformations.h"
#include "bench/studies.h"
#include "palpate/files/read.h"
#include "palpate/mesh/repair.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace palpate::studies {

namespace {

std::optional<std::filesystem::path> find_dragon() {
    const char* folder = std::getenv("PALPATE_DATA");
    const std::filesystem::path path =
        std::filesystem::path(folder ? folder : "") / "dragon_vrip_res2.ply.gz";
    if (!std::filesystem::exists(path)) return std::nullopt;
    return path;
}

// As scenes/dragon.toml makes it.
Mesh read_dragon(const std::filesystem::path& path) {
    Mesh mesh = read_mesh(path, Units::metres);
    weld(mesh);
    drop_collapsed(mesh);
    keep_largest(mesh);
    decimate(mesh, 10'015);
    keep_largest(mesh);
    return mesh;
}

}  // namespace

// How well each mapping follows a twist of 90° and a bend of 90° that are given in closed form: positions in
// spacings, normals in degrees.
void print_mappings() {
    std::vector<Carrier> all = carriers();
    if (const auto dragon = find_dragon())
        all.push_back(on_a_sheet_of_18("dragon of 2005", read_dragon(*dragon)));
    else
        fmt::print(
            "The dragon is not available: scripts/get-data fetches it, PALPATE_DATA names its folder.\n\n");
    for (const Carrier& carrier : all) {
        fmt::print("{}: {} nodes, {} vertices\n\n", carrier.name, carrier.body.count(),
                   carrier.surface.positions.size());
        fmt::print(
            "| mapping | twist: rms | largest | normals: mean | largest | bend: rms | largest | normals: "
            "mean | largest |\n");
        fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
        for (const auto& [mapping, name] : names(Mapping{})) {
            if (mapping == Mapping::trilinear && carrier.body.cells.empty()) continue;
            const Embedding skin = embed(carrier.surface, carrier.body, mapping);
            fmt::print("| {} |", name);
            for (const Deformation* d : {&carrier.twisted, &carrier.bent}) {
                const Misfit m = misfit(carrier, skin, *d);
                fmt::print(" {:.4f} | {:.3f} | {:.2f}° | {:.1f}° |", m.rms, m.largest, m.mean_angle,
                           m.largest_angle);
            }
            fmt::print("\n");
        }
        fmt::print("\n");
    }
}

}  // namespace palpate::studies
