// Prints the tables of docs/results.md that compare measurements with theory:
//   palpate-tables [TABLE...]           orders, stability, waves, cantilever, energy, dents, walls, mappings,
//                                       rest, swings, touches, nodules, momentum [all]
//   palpate-tables --plot FILE [PLOT]   draws as SVG the map of walls, that of touches, or nodules [walls]
#include "bench/felt.h"
#include "bench/studies.h"
#include "bench/walls.h"
#include "palpate/base/error.h"
#include "palpate/run/plot.h"
#include "palpate/touch/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace palpate;
using namespace palpate::studies;

// How the 2012 paper ranks an integrator, if it does.
const char* rank_in_2012(Integrator integrator) {
    return integrator == Integrator::rk4              ? "the best"
           : integrator == Integrator::explicit_euler ? "the worst"
           : integrator == Integrator::verlet         ? "stable"
                                                      : "";
}

void orders() {
    fmt::print("| body | integrator |");
    for (const Damping& damping : dampings) fmt::print(" damping: {} |", damping.name);
    fmt::print("\n| --- | --- | --- | --- | --- |\n");
    for (const auto& [body, about] : {std::pair{&chain, "springs"}, {&tissue_chain, "tissue"}})
        for (const auto& [integrator, name] : names(Integrator{})) {
            fmt::print("| {} | {} |", about, name);
            for (const Damping& damping : dampings)
                fmt::print(" {:.2f}, {:.2f} |", order(body, integrator, damping, 128),
                           order(body, integrator, damping, 256));
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
            fmt::print(" {} |\n", first ? rank_in_2012(integrator) : "");
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
    auto print = [](std::string_view name, const studies::Swing& s) {
        fmt::print("| {} | {:.3f} to {:.3f} | {:+.3f} % |\n", name, s.least, s.largest, 100 * s.drift);
    };
    for (Integrator integrator :
         {Integrator::semi_implicit_euler, Integrator::verlet, Integrator::verlet_midpoint, Integrator::rk4})
        print(name_of(integrator), energy_swing(integrator, 1'000'000));
    print("verlet, tissue", energy_swing(Integrator::verlet, 1'000'000, MaterialModel::tissue));
}

void dents() {
    fmt::print(
        "| σ/R | depth/σ | dented_normal() | 2007 as printed | exponent corrected | axis normalised | both "
        "|\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (double width : {0.0, 0.05, 0.1, 0.2, 0.5, 1.0})
        for (double depth : {0.1, 0.3, 1.0, 2.0}) {
            if (!(width * depth < 1)) continue;
            const DentNormals off = dent_normals(width, depth);
            fmt::print("| {} | {} | {:.2f}° | {:.1f}° | {:.1f}° | {:.1f}° | {:.2f}° |\n", width, depth,
                       off.ours, off.printed, off.with_exponent, off.with_axis, off.with_both);
        }
}

void walls() {
    fmt::print(
        "| ticks a second | damping, N·s/m | passive, N/m | linear | measured | with the observer |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (double rate : {500.0, 1000.0, 2000.0})
        for (double damping : {0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 200.0}) {
            const Wall wall{.damping = damping, .rate = rate};
            fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", rate, damping,
                       stiffest_passive(wall), stiffest_linear(wall), stiffest_measured(wall),
                       stiffest_measured(wall, SafetySettings{}.most_damping));
        }
    fmt::print("\n| hand, kg | its damping, N·s/m | linear, N/m | measured |\n| --- | --- | --- | --- |\n");
    for (double mass : {0.05, VirtualHandSettings{}.mass})
        for (double damping : {0.3, 0.6, 1.0, 2.0, VirtualHandSettings{}.damping}) {
            Wall wall;
            wall.hand.mass = mass;
            wall.hand.damping = damping;
            fmt::print("| {} | {} | {:.0f} | {:.0f} |\n", mass, damping, stiffest_linear(wall),
                       stiffest_measured(wall));
        }
}

// ---- a hand on a simulated body ----

constexpr double slices[] = {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000};  // s
constexpr double mapped_slices[] = {1.0 / 60, 1.0 / 240, 1.0 / 1000};

std::string fraction(double slice) { return fmt::format("1/{:.0f}", 1 / slice); }

void rest() {
    const FeltBlock block;
    const double depth = 0.005, still = pressed_at_rest(block, {&depth, 1})[0];
    fmt::print("At rest the reference in double is pushed back with {:.4f} N.\n\n", still);
    fmt::print("| slice, s | 500 ticks a second | 1000 | 2000 |\n| --- | --- | --- | --- |\n");
    for (double slice : slices) {
        fmt::print("| {} |", fraction(slice));
        for (double rate : {500.0, 1000.0, 2000.0})
            fmt::print(" {:+.3f} % |", 100 * (felt_at_rest(block, depth, {slice, rate}) / still - 1));
        fmt::print("\n");
    }
}

// What becomes of the force that passivity control takes from a hand.
struct Control {
    const char* name;
    double most_damping, gives_back_in;  // N·s/m; s
};
constexpr Control controls[] = {{"on", SafetySettings{}.most_damping, 0},
                                {"off", 0, 0},
                                {"on, given back in 50 ms", SafetySettings{}.most_damping, 0.05}};

void swings() {
    fmt::print(
        "| passivity control | slice, s | 1 Hz: amplitude | phase | 2 Hz: amplitude | phase |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (const Control& control : controls) {
        std::vector<FeltClock> clocks;
        for (double slice : slices)
            clocks.push_back({.slice = slice, .gives_back_in = control.gives_back_in});
        const FeltBlock block{.most_damping = control.most_damping};
        const auto slow = felt_swings(block, 1, clocks), fast = felt_swings(block, 2, clocks);
        for (std::size_t c = 0; c < clocks.size(); ++c)
            fmt::print("| {} | {} | {:.3f} | {:+.1f}° | {:.3f} | {:+.1f}° |\n", control.name,
                       fraction(clocks[c].slice), slow[c].amplitude, slow[c].ahead, fast[c].amplitude,
                       fast[c].ahead);
    }
}

void touches() {
    fmt::print("| slice, s | rigid: Colgate and Schenkel, N/m | linear |\n| --- | --- | --- |\n");
    for (double slice : mapped_slices)
        fmt::print("| {} | {:.0f} | {:.0f} |\n", fraction(slice), stiffest_passive(FeltHold{0, slice}),
                   stiffest_linear(FeltHold{0, slice}));
    fmt::print("\n| Young's modulus, kPa |");
    for (double slice : mapped_slices) fmt::print(" {} s: measured, N/m | linear |", fraction(slice));
    fmt::print("\n| --- | --- | --- | --- | --- | --- | --- |\n");
    auto print = [](double stiffness) {
        if (stiffness < StiffestTouch::most)
            fmt::print(" {:.0f} |", stiffness);
        else
            fmt::print(" any |");
    };
    for (double kilo : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0, 1000.0}) {
        fmt::print("| {} |", kilo);
        for (double slice : mapped_slices) {
            const StiffestTouch found = stiffest_touch({1000 * kilo, slice});
            print(found.measured);
            print(found.linear);
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
}

constexpr double stroked = 0.003;  // m, how deep
constexpr double nodule_depths[] = {0.005, 0.010, 0.015};

FeltStroke stroke_over(std::optional<double> nodule, double spacing = palpated.spacing) {
    FeltBlock block = palpated;
    block.spacing = spacing;
    if (nodule) block.nodule = Nodule{.depth = *nodule};
    return felt_stroke(block, stroked);
}

void nodules() {
    fmt::print(
        "| cells, mm | without, N | over it at 5 mm | at 10 mm | at 15 mm |\n| --- | --- | --- | --- | --- "
        "|\n");
    for (double spacing : {0.004, 0.003, 0.002}) {
        const FeltStroke without = stroke_over({}, spacing);
        const double plain = without.forces[without.forces.size() / 2];
        fmt::print("| {:.0f} | {:.4f} |", 1000 * spacing, plain);
        for (double depth : nodule_depths)
            fmt::print(" {:+.1f} % |", 100 * excess(stroke_over(depth, spacing), without) / plain);
        fmt::print("\n");
        std::fflush(stdout);
    }
}

void momentum() {
    fmt::print(
        "| passivity control | slice, s | given, mN s | felt | less |\n| --- | --- | --- | --- | --- |\n");
    for (const Control& control : controls)
        for (double slice : slices) {
            const GivenAndFelt both = momentum_of_a_free_block(
                {.slice = slice, .gives_back_in = control.gives_back_in}, control.most_damping);
            fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} % |\n", control.name, fraction(slice),
                       1000 * both.given, 1000 * both.felt, 100 * (1 - both.felt / both.given));
        }
}

// The graph of a function from 0 to `most`.
Curve curve(std::string name, double most, int parts, const std::function<double(double)>& height) {
    Curve drawn{std::move(name), {}, {}};
    for (int i = 0; i <= parts; ++i) {
        drawn.x.push_back(most * i / parts);
        drawn.y.push_back(height(drawn.x.back()));
    }
    return drawn;
}

// The curves end early enough to leave room for their names.
void draw_walls(const std::filesystem::path& path) {
    Panel whole{"damping of the wall (N·s/m)", "stiffness (N/m)", {}}, near = whole;
    for (double rate : {500.0, 1000.0, 2000.0}) {
        whole.curves.push_back(curve(fmt::format("{} Hz, linear", rate), 500, 100, [&](double b) {
            return stiffest_linear({.damping = b, .rate = rate});
        }));
        whole.curves.push_back(curve(fmt::format("{} Hz, measured", rate), 250, 25, [&](double b) {
            return stiffest_measured({.damping = b, .rate = rate});
        }));
    }
    const double most = 8;
    near.curves = {
        curve("1000 Hz, linear", most, 16, [](double b) { return stiffest_linear({.damping = b}); }),
        curve("measured", most, 16, [](double b) { return stiffest_measured({.damping = b}); }),
        curve("with the observer", most, 16,
              [](double b) { return stiffest_measured({.damping = b}, SafetySettings{}.most_damping); }),
        curve("half of the linear", most, 16, [](double b) { return 0.5 * stiffest_linear({.damping = b}); }),
        curve("passive", 1.5 * most, 120, [](double b) { return stiffest_passive({.damping = b}); }),
        {"the default", {0, Feel{}.damping, Feel{}.damping}, {Feel{}.stiffness, Feel{}.stiffness, 0}}};
    write_plot("The stiffest wall on which a hand comes to rest", {whole, near}, path);
}

void draw_touches(const std::filesystem::path& path) {
    Panel map{"Young's modulus (kPa)", "stiffness (N/m)", {}, true};
    for (double slice : mapped_slices) {
        Curve measured{fraction(slice) + " s, measured", {}, {}},
            linear{fraction(slice) + " s, linear", {}, {}};
        for (double kilo : {30.0, 50.0, 70.0, 100.0, 150.0, 200.0, 300.0, 500.0, 1000.0}) {
            const StiffestTouch found = stiffest_touch({1000 * kilo, slice});
            for (auto [curve, stiffness] : {std::pair{&measured, found.measured}, {&linear, found.linear}})
                if (stiffness < StiffestTouch::most) {
                    curve->x.push_back(kilo);
                    curve->y.push_back(stiffness);
                }
        }
        map.curves.push_back(measured);
        map.curves.push_back(linear);
    }
    map.curves.push_back({"the default", {30, 1000}, {Feel{}.stiffness, Feel{}.stiffness}});
    write_plot("The stiffest touch of a block of tissue that comes to rest", {map}, path);
}

// One point a millimetre.
Curve thinned(std::string name, const FeltStroke& stroke) {
    Curve curve{std::move(name), {}, {}};
    for (std::size_t i = 0; i < stroke.places.size(); ++i)
        if (curve.x.empty() || 1000 * stroke.places[i] >= curve.x.back() + 1) {
            curve.x.push_back(1000 * stroke.places[i]);
            curve.y.push_back(stroke.forces[i]);
        }
    return curve;
}

void draw_nodules(const std::filesystem::path& path) {
    Panel panel{"place (mm)", "force (N)", {thinned("no nodule", stroke_over({}))}};
    for (double depth : nodule_depths)
        panel.curves.push_back(thinned(fmt::format("{:.0f} mm deep", 1000 * depth), stroke_over(depth)));
    write_plot("A stroke over a hard nodule", {panel}, path);
}

}  // namespace

int main(int count, char** arguments) {
    const std::vector<std::pair<std::string, void (*)()>> tables = {
        {"orders", orders},    {"stability", stability}, {"waves", waves},     {"cantilever", cantilever},
        {"energy", energies},  {"dents", dents},         {"walls", walls},     {"mappings", print_mappings},
        {"rest", rest},        {"swings", swings},       {"touches", touches}, {"nodules", nodules},
        {"momentum", momentum}};
    const std::map<std::string, void (*)(const std::filesystem::path&)> plots = {
        {"walls", draw_walls}, {"touches", draw_touches}, {"nodules", draw_nodules}};
    const std::vector<std::string> wanted(arguments + 1, arguments + count);
    if ((wanted.size() == 2 || wanted.size() == 3) && wanted[0] == "--plot") try {
            const auto plot = plots.find(wanted.size() == 3 ? wanted[2] : "walls");
            if (plot == plots.end())
                throw Error(fmt::format("no plot \"{}\"", wanted[2]), "palpate-tables",
                            "there are nodules, touches, walls");
            plot->second(wanted[1]);
            return 0;
        } catch (const Error& error) {
            fmt::print(stderr, "palpate-tables: {}\n", error.what());
            return 1;
        }
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
