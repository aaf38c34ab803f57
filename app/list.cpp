#include "app/commands.h"
#include "palpate/palpate.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace palpate;

template <class E>
void print_names() {
    for (const auto& n : names(E{})) fmt::print("{}\n", n.name);
}

void print_devices() {
    for (const Driver& driver : drivers()) fmt::print("{:<8} {}\n", driver.name, driver.about);
}

void print_scenes() {
    for (const ShippedScene& scene : shipped_scenes()) fmt::print("{:<8} {}\n", scene.name, scene.about);
}

void print_tissues() {
    for (const Tissue& one : tissues())
        fmt::print("{:<12} {:>5.3g} kPa ({:.3g} to {:.3g}), Poisson's ratio {:.2f}, {:>4} kg/m³; {}; {}\n",
                   one.name, one.youngs_modulus / 1000, one.low / 1000, one.high / 1000, one.poisson,
                   one.density, one.about, one.source);
}

}  // namespace

void add_list(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("list", "List backends, integrators, mappings, devices, tissues or scenes");
    command->require_subcommand(1);
    auto add = [&](const char* name, const char* about, auto print) {
        command->add_subcommand(name, about)->callback(print);
    };
    add("backends", "where a body's motion can be computed", print_names<Backend>);
    add("integrators", "how it can be integrated over time", print_names<Integrator>);
    add("mappings", "how a surface can follow the nodes", print_names<Mapping>);
    add("devices", "where a tool's motion can come from", print_devices);
    add("tissues", "what a body can be made of", print_tissues);
    add("scenes", "the scenes that come with Palpate", print_scenes);
}
