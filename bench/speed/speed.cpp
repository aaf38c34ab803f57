#include "bench/speed/speed.h"

#include "palpate/base/clock.h"
#include "palpate/gl/context.h"
#include "palpate/solver/scheme.h"
#include "palpate/solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace palpate::speed {
namespace {

Rate rate_of(std::vector<double> rates) {
    if (rates.empty()) return {};
    std::sort(rates.begin(), rates.end());
    return {rates.back(), rates[rates.size() / 2]};
}

// Read or written by the passes of a step, with nothing fetched twice: the state at which forces are taken,
// that at which the step began, the sum, the shares of 18 links (eight bytes) and the inverse mass. On a GPU
// everything is padded to four floats.
double bytes_of_a_step(Integrator integrator, bool gpu) {
    const double state = gpu ? 32 : 24, fixed = gpu ? 16 : 12;
    double bytes = 0;
    for (const Stage& stage : scheme(integrator).stages) {
        const bool first = &stage == &scheme(integrator).stages.front();
        bytes += state + fixed + state;                             // at, next
        bytes += first ? 0 : state;                                 // where the step began, or the sum
        bytes += stage.part > 0 ? (first ? state : 2 * state) : 0;  // to the sum
    }
    return bytes;
}

}  // namespace

const Rate* Timings::find(const std::string& name) const {
    for (std::size_t c = 0; c < cases.size(); ++c)
        if (cases[c].name == name) return &rates[c];
    return nullptr;
}

Cell cell_of(const std::string& name) {
    const auto first = name.find(" / "), last = name.rfind(" / ");
    return {name.substr(0, first), name.substr(first + 3, last - first - 3), name.substr(last + 3)};
}

void Outline::add(const Cell& cell) {
    auto note = [](std::vector<std::string>& list, const std::string& name) {
        if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    note(rows, cell.row);
    note(columns, cell.column);
}

int times_for(double seconds) { return std::clamp(int(0.05 / seconds), 1, 100); }

Timings time(std::vector<Case> cases, int rounds, int limits) {
    const std::size_t most =
        limits < 0 ? std::max(1u, std::thread::hardware_concurrency()) : std::size_t(limits);
    std::vector<std::vector<double>> rates(cases.size()), links(most), bytes(most);
    auto run = [](const std::function<Work()>& work, std::vector<double>& into) {
        const Work done = work();
        into.push_back(done.amount / done.seconds);
    };
    // A warm-up round: a graphics driver may recompile shaders for the state that another case left.
    for (const Case& of : cases) of.run();
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t t = 0; t < most; ++t) {
            run([&] { return arithmetic(int(t) + 1); }, links[t]);
            run([&] { return copying(int(t) + 1); }, bytes[t]);
        }
        for (std::size_t c = 0; c < cases.size(); ++c) run(cases[c].run, rates[c]);
    }
    Timings timings{std::move(cases), {}, {}, {}};
    for (auto& list : rates) timings.rates.push_back(rate_of(list));
    for (auto& list : links) timings.arithmetic.push_back(rate_of(list));
    for (auto& list : bytes) timings.copying.push_back(rate_of(list));
    return timings;
}

Case stepping(std::string name, const Body& body, const Simulation& how, const gl::Context* context,
              int steps_a_call) {
    Simulation simulation = how;
    simulation.step = 1e-5;
    simulation.force = true;
    simulation.shortest_step = 0;
    std::shared_ptr<Solver> solver = make_solver(body, simulation, context);
    const double nodes = double(body.count());
    auto go = [=](int steps) {
        const double start = now();
        for (int left = steps; left > 0; left -= steps_a_call)
            solver->step(std::min(left, steps_a_call) * simulation.step);
        if (context) context->finish();
        return now() - start;
    };
    go(4);  // warm-up: a driver may compile shaders
    const int steps = std::max(times_for(go(4) / 4), 2);
    double forces = 0;  // a step
    for (const Stage& stage : scheme(simulation.integrator).stages) forces += stage.kick > 0;
    return {std::move(name),
            [=] {
                return Work{go(steps), nodes * steps};
            },
            tissue_of(body) ? 0 : table(body).width * forces,
            bytes_of_a_step(simulation.integrator, solver->gpu_nodes().positions != 0),
            double(solver->memory()) / nodes,
            simulation.threads};
}

std::string markdown(const Timings& timings, const std::string& unit) {
    std::string text = fmt::format(
        "| | {} a second: best | median | links a second | of the arithmetic limit | bytes moved for each | "
        "of a copy "
        "| bytes kept for each |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        unit);
    auto millions = [](double a) { return fmt::format("{:.{}f} M", a / 1e6, a < 1e7 ? 2 : 0); };
    for (std::size_t t = 0; t < timings.arithmetic.size(); ++t)
        text += fmt::format("| the limits, {} thread{} | | | {} ({}) | 1 | | {:.1f} GB/s ({:.1f}) | |\n",
                            t + 1, t > 0 ? "s" : "", millions(timings.arithmetic[t].best),
                            millions(timings.arithmetic[t].median), timings.copying[t].best / 1e9,
                            timings.copying[t].median / 1e9);
    for (std::size_t c = 0; c < timings.cases.size(); ++c) {
        const Case& of = timings.cases[c];
        const Rate rate = timings.rates[c];
        const std::size_t threads = std::min(std::size_t(of.threads), timings.arithmetic.size()) - 1;
        text += fmt::format("| {} | {} | {} |", of.name, millions(rate.best), millions(rate.median));
        text += of.links > 0 ? fmt::format(" {} |", millions(of.links * rate.best)) : " |";
        text += of.links > 0 ? fmt::format(" {:.2f} ({:.2f}) |",
                                           of.links * rate.best / timings.arithmetic[threads].best,
                                           of.links * rate.median / timings.arithmetic[threads].median)
                             : " |";
        text += of.bytes > 0 ? fmt::format(" {:.0f} | {:.2f} ({:.2f}) |", of.bytes,
                                           of.bytes * rate.best / timings.copying[threads].best,
                                           of.bytes * rate.median / timings.copying[threads].median)
                             : " | |";
        text += of.memory > 0 ? fmt::format(" {:.0f} |\n", of.memory) : " |\n";
    }
    return text;
}

const std::vector<Benchmark>& benchmarks() {
    auto plain = [](std::string name, std::string about, std::string unit, std::vector<Case> (*cases)()) {
        return Benchmark{std::move(name), std::move(about), true,
                         [cases](int rounds) { return time(cases(), rounds); },
                         [unit](const Timings& timings) { return markdown(timings, unit); }};
    };
    static const std::vector<Benchmark> all = {
        plain("lattice", "steps of lattices, against the machine's limits and Bullet", "node-steps",
              lattice_cases),
        plain("cloth", "steps of cloths", "node-steps", cloth_cases),
        plain("embed", "a surface of 160,000 vertices carried by its nodes", "vertices", embed_cases),
        pipeline(),
        heart(),
        touch(),
        live(),
        tissue_study(),
#ifdef PALPATE_VIEWER
        viewer(),
#endif
    };
    return all;
}

}  // namespace palpate::speed
