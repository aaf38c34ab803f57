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

}  // namespace

void add_list(CLI::App& app) {
    CLI::App* command = app.add_subcommand("list", "List backends, integrators, mappings, devices or scenes");
    command->require_subcommand(1);
    auto add = [&](const char* name, const char* about, auto print) {
        command->add_subcommand(name, about)->callback(print);
    };
    add("backends", "where a body's motion can be computed", print_names<Backend>);
    add("integrators", "how it can be integrated over time", print_names<Integrator>);
    add("mappings", "how a surface can follow the nodes", print_names<Mapping>);
    add("devices", "where a tool's motion can come from", print_devices);
    add("scenes", "the scenes that come with Palpate", print_scenes);
}
