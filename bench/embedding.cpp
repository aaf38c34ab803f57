#include "bench/deformations.h"
#include "bench/studies.h"

#include <fmt/format.h>

namespace palpate::studies {

// How well each mapping follows a twist of 90° and a bend of 90° that are given in closed form: positions in
// spacings, normals in degrees.
void print_mappings() {
    for (const Carrier& carrier : carriers()) {
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
