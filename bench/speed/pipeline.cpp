// The tables of the 2012 paper, section 5.
#include "bench/speed/drawing.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace palpate::speed {
namespace {

constexpr int grids[] = {64, 128, 256, 512, 1024};
constexpr double frame_step = 1e-5;  // s
constexpr auto euler = Integrator::explicit_euler;

std::string all_threads() {
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    return fmt::format("cpu, {} thread{}", cores, cores > 1 ? "s" : "");
}

std::string frame_of(int grid, const std::string& mover, Integrator integrator) {
    return fmt::format("{}², {}, {}, a frame", grid, mover, name_of(integrator));
}
std::string step_of(int grid, const std::string& mover) {
    return fmt::format("{}², {}, a step", grid, mover);
}
std::string copy_of(int grid) { return fmt::format("{}², copying on the GPU", grid); }

// A step, and its nodes drawn.
Case frame(int grid, const Body& body, double frequency, const Hardware& hardware,
           const Hardware::Mover& mover, Integrator integrator) {
    const Simulation how{.backend = mover.backend,
                         .threads = mover.threads,
                         .integrator = integrator,
                         .step = frame_step,
                         .force = true,
                         .shortest_step = 0};
    std::shared_ptr<Solver> solver = make_solver(body, how, hardware.gl(), frequency);
    auto points = std::make_shared<Points>(body);
    return repeating(
        frame_of(grid, mover.name, integrator),
        [=] {
            solver->step(frame_step);
            points->draw(*solver);
        },
        hardware.gl());
}

void add(Timings& all, Timings more) {
    std::move(more.cases.begin(), more.cases.end(), std::back_inserter(all.cases));
    all.rates.insert(all.rates.end(), more.rates.begin(), more.rates.end());
}

// Cases that are compared are interleaved; the memory of the others is freed before.
Timings run(int rounds) {
    const Hardware hardware;
    Timings all;
    all.driver = hardware.driver();
    auto time_and_drop = [&](std::vector<Case> cases) {
        Timings timed = time(std::move(cases), rounds, 0);
        for (Case& of : timed.cases) of.run = {};
        add(all, std::move(timed));
    };
    for (int grid : grids) {
        const Body body = cloth(ivec2(grid), 0.01f, linen);
        const double frequency = highest_frequency(body);
        std::vector<Case> cases;
        for (const auto& mover : hardware.movers)
            cases.push_back(steps(step_of(grid, mover.name), body, hardware, mover, euler));
        if (hardware.gl()) {
            cases.push_back(copying_on_gpu(copy_of(grid), *hardware.gl()));
            for (const auto& mover : hardware.movers)
                cases.push_back(frame(grid, body, frequency, hardware, mover, euler));
        }
        time_and_drop(std::move(cases));
        for (const auto& mover : hardware.movers) {
            if (!hardware.gl() || mover.backend == Backend::reference) continue;
            cases.clear();
            for (const auto& [integrator, name] : names(Integrator{}))
                if (integrator != euler)
                    cases.push_back(frame(grid, body, frequency, hardware, mover, integrator));
            time_and_drop(std::move(cases));
        }
    }
    return all;
}

std::string size(int grid) { return fmt::format("{} × {}", grid, grid); }

std::string ratio(const Rate* one, const Rate* other) {
    if (!one || !other) return "–";
    return fmt::format("{:.1f} ({:.1f})", one->best / other->best, one->median / other->median);
}

std::string of_a_copy(const Timings& timings, int grid, const std::string& mover) {
    const Rate *step = timings.find(step_of(grid, mover)), *copy = timings.find(copy_of(grid));
    if (!step || !copy) return "–";
    double bytes = 0;
    for (const Case& of : timings.cases)
        if (of.name == step_of(grid, mover)) bytes = of.bytes;
    return fmt::format("{:.2f} ({:.2f})", bytes * step->best / copy->best,
                       bytes * step->median / copy->median);
}

// A table with a row for each grid.
template <class Row>
std::string table(std::vector<std::string> columns, const Row& cells) {
    std::string text = head(columns);
    for (int grid : grids) text += row(std::vector<std::string>(cells(grid)));
    return text + "\n";
}

std::string text(const Timings& timings) {
    const std::string all = all_threads();
    auto ms = [&](int grid, const std::string& mover, Integrator integrator = euler) {
        return milliseconds(timings, frame_of(grid, mover, integrator));
    };
    std::string text = fmt::format(
        "{}\n\nMilliseconds a frame: one step of a cloth of 12 springs a node, and its nodes drawn as "
        "points; best, and median in brackets. The GPU is waited for after several frames, not after "
        "each. The CPU's positions are uploaded, the GPU's stay there.\n\n",
        timings.driver);
    text += "Table 1: unoptimised and optimised CPU, explicit Euler.\n\n";
    text +=
        table({"Grid", "Unoptimised CPU (a)", "Optimised CPU (b), 1 thread", "(b), " + all, "Speed-up a/b"},
              [&](int grid) -> std::vector<std::string> {
                  return {size(grid), ms(grid, "reference"), ms(grid, "cpu, 1 thread"), ms(grid, all),
                          ratio(timings.find(frame_of(grid, all, euler)),
                                timings.find(frame_of(grid, "reference", euler)))};
              });
    text += "Table 2: the backends, explicit Euler.\n\n";
    text +=
        table({"Grid", "CPU (a), " + all, "GPU-CUDA (b), (c)", "GPU-TF (d): feedback", "fragment", "compute"},
              [&](int grid) -> std::vector<std::string> {
                  return {size(grid),           ms(grid, all),        "not built",
                          ms(grid, "feedback"), ms(grid, "fragment"), ms(grid, "compute")};
              });
    text += "Table 3: the integrators.\n\n";
    std::vector<std::string> columns{"Grid"};
    for (const auto& n : names(Integrator{})) columns.emplace_back(n.name);
    for (const std::string& mover :
         {std::string("feedback"), std::string("fragment"), std::string("compute"), all}) {
        columns[0] = "Grid, " + mover;
        text += table(columns, [&](int grid) {
            std::vector<std::string> cells{size(grid)};
            for (const auto& n : names(Integrator{})) cells.push_back(ms(grid, mover, n.value));
            return cells;
        });
    }
    const std::vector<std::string> movers{"reference", "cpu, 1 thread", all,
                                          "feedback",  "fragment",      "compute"};
    text +=
        "A step alone, explicit Euler, many in a call, in milliseconds; and for the GPU its memory "
        "throughput (80 bytes a node, nothing fetched twice) over that of a copy of 64 MB from buffer to "
        "buffer in the same run.\n\n";
    columns = {"Grid"};
    columns.insert(columns.end(), movers.begin(), movers.end());
    for (const char* gpu : {"feedback", "fragment", "compute"})
        columns.push_back(fmt::format("{}, of a copy", gpu));
    columns.push_back("a copy, GB/s");
    text += table(columns, [&](int grid) {
        std::vector<std::string> cells{size(grid)};
        for (const std::string& mover : movers) cells.push_back(milliseconds(timings, step_of(grid, mover)));
        for (const char* gpu : {"feedback", "fragment", "compute"})
            cells.push_back(of_a_copy(timings, grid, gpu));
        const Rate* copy = timings.find(copy_of(grid));
        cells.push_back(copy ? fmt::format("{:.1f} ({:.1f})", copy->best / 1e9, copy->median / 1e9) : "–");
        return cells;
    });
    return text;
}

std::vector<Panel> curves(const Timings& timings) {
    Panel frames{"nodes", "ms a frame", {}, true}, alone{"nodes", "ms a step", {}, true};
    for (const std::string& mover :
         {std::string("reference"), std::string("cpu, 1 thread"), all_threads(), std::string("feedback"),
          std::string("fragment"), std::string("compute")}) {
        auto curve = [&](Panel& panel, auto name) {
            Curve one{mover, {}, {}};
            for (int grid : grids)
                if (const Rate* rate = timings.find(name(grid))) {
                    one.x.push_back(double(grid) * grid);
                    one.y.push_back(1e3 / rate->best);
                }
            if (!one.x.empty()) panel.curves.push_back(std::move(one));
        };
        curve(frames, [&](int grid) { return frame_of(grid, mover, euler); });
        curve(alone, [&](int grid) { return step_of(grid, mover); });
    }
    return {frames, alone};
}

}  // namespace

Benchmark pipeline() {
    return {"pipeline", "cloths moved and drawn, the tables of 2012", false, run, text, curves};
}

}  // namespace palpate::speed
