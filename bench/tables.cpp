// Prints the tables of docs/results.md that compare measurements with theory:
//   palpate-tables [orders] [stability] [waves] [cantilever] [energy] [dents] [mappings]    all, if none is
//   named
#include "bench/studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using namespace palpate;
using namespace palpate::studies;

// The ranking of 2012, where it says one.
const char* said_in_2012(Integrator integrator) {
    return integrator == Integrator::rk4              ? "the best"
           : integrator == Integrator::explicit_euler ? "the worst"
           : integrator == Integrator::verlet         ? "stable"
                                                      : "";
}

void orders() {
    fmt::print("| integrator |");
    for (const Damping& damping : dampings) fmt::print(" damping: {} |", damping.name);
    fmt::print("\n| --- | --- | --- | --- |\n");
    for (const auto& [integrator, name] : names(Integrator{})) {
        fmt::print("| {} |", name);
        for (const Damping& damping : dampings)
            fmt::print(" {:.2f}, {:.2f} |", order(integrator, damping, 128), order(integrator, damping, 256));
        fmt::print("\n");
    }
}

void stability() {
    fmt::print(
        "| integrator | damping | predicted ω dt | measured ω dt | in 2012 |\n| --- | --- | --- | --- | --- "
        "|\n");
    for (const auto& [integrator, name] : names(Integrator{}))
        for (const Damping& damping : dampings) {
            const bool first = &damping == dampings;
            fmt::print("| {} | {} |", first ? name : "", damping.name);
            const Limit limit = stability_limit(integrator, damping);
            if (limit.predicted > 0) {
                fmt::print(" {:.4f} | {:.4f} |", limit.predicted * limit.frequency,
                           limit.measured * limit.frequency);
            } else {
                const Growth g = growth_per_step(integrator, 0.5);
                fmt::print(" none: at 0.5 it grows by {:.3f} % a step | {:.3f} % |", 100 * g.predicted,
                           100 * g.measured);
            }
            fmt::print(" {} |\n", first ? said_in_2012(integrator) : "");
        }
}

void waves() {
    fmt::print("| pulse | speed over theory |\n| --- | --- |\n");
    fmt::print("| longitudinal, √(3k/(hρ)) | {:.4f} |\n", pulse_speed(false));
    fmt::print("| shear, √(k/(hρ)) | {:.4f} |\n", pulse_speed(true));
}

void cantilever() {
    fmt::print("| cells thick | sag over Timoshenko's |\n| --- | --- |\n");
    for (int cells : {1, 2, 4, 5, 8}) fmt::print("| {} | {:.3f} |\n", cells, cantilever_sag(cells));
}

void energies() {
    fmt::print(
        "| integrator | energy of a million undamped steps over the first | drift of its mean |\n| --- | --- "
        "| --- |\n");
    for (Integrator integrator : {Integrator::semi_implicit_euler, Integrator::verlet,
                                  Integrator::verlet_midpoint, Integrator::rk4}) {
        const Swing s = energy_swing(integrator, 1'000'000);
        fmt::print("| {} | {:.3f} to {:.3f} | {:+.3f} % |\n", name_of(integrator), s.least, s.largest,
                   100 * s.drift);
    }
}

void dents() {
    fmt::print(
        "| σ/R | depth/σ | dented_normal() | 2007 as printed | its exponent mended | its axis unit | both |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (double width : {0.0, 0.05, 0.1, 0.2, 0.5, 1.0})
        for (double depth : {0.1, 0.3, 1.0, 2.0}) {
            if (!(width * depth < 1)) continue;
            const DentNormals off = dent_normals(width, depth);
            fmt::print("| {} | {} | {:.2f}° | {:.1f}° | {:.1f}° | {:.1f}° | {:.2f}° |\n", width, depth,
                       off.ours, off.printed, off.with_exponent, off.with_axis, off.with_both);
        }
}

}  // namespace

int main(int count, char** arguments) {
    const std::vector<std::pair<std::string, void (*)()>> tables = {
        {"orders", orders},          {"stability", stability}, {"waves", waves},
        {"cantilever", cantilever},  {"energy", energies},     {"dents", dents},
        {"mappings", print_mappings}};
    const std::vector<std::string> wanted(arguments + 1, arguments + count);
    for (const std::string& name : wanted)
        if (std::none_of(tables.begin(), tables.end(), [&](const auto& t) { return t.first == name; })) {
            fmt::print(stderr, "palpate-tables: no table \"{}\"\n", name);
            return 2;
        }
    for (const auto& [name, print] : tables) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
        fmt::print("\n{}:\n\n", name);
        print();
        std::fflush(stdout);
    }
}
