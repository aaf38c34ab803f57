// A hand that presses the body that it feels, in real time: how often the body answers, and how well both
// keep time.
#include "bench/speed/drawing.h"
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"
#include "palpate/body/lattice.h"
#include "palpate/run/live_touch.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "tests/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace palpate::speed {
namespace {

constexpr double seconds_a_round = 2, warm_up = 1.5;  // the latter until its force has ramped up
constexpr float tip = 0.014f;                         // m
constexpr struct { int nodes, threads; } sizes[] = {{5'000, 1}, {20'000, 1}, {80'000, 1}, {80'000, 2}};

// The brain without its own tool; where its volume is not there, an ellipsoid of the same size and tissue.
Prepared subject(int nodes, int threads) {
    SceneText scene = find_scene("brain");
    scene.text.erase(std::min(scene.text.find("[[tool]]"), scene.text.size()));
    try {
        return prepare(
            scene, {fmt::format("body.1.nodes={}", nodes), fmt::format("simulation.threads={}", threads)});
    } catch (const Error& error) {
        fmt::print(stderr, "brain: not available, an ellipsoid stands in: {}\n", error.what());
    }
    const Mesh surface = ellipsoid(vec3(0.07f, 0.065f, 0.09f), 187);
    Prepared prepared = prepare(
        lattice(surface, {.nodes = nodes, .material = {.youngs_modulus = 1640, .density = 1040}}), surface);
    prepared.models.simulation.threads = threads;
    return prepared;
}

// Presses the surface from above beside its middle, 10 mm deep, and strokes it, again and again.
Path pressing(const Mesh& surface, float beside) {
    vec3 top(0, -1e6f, 0);
    for (vec3 p : surface.positions)
        if (std::abs(p.x - beside) < 0.01f && p.y > top.y) top = p;
    Path path{{0, top + vec3(0, 2 * tip, 0)}};
    for (double time = 0.3; time < 600;) {
        path.push_back({time += 0.2, top + vec3(0, tip + 0.002f, 0)});
        path.push_back({time += 0.3, top + vec3(0, tip - 0.010f, 0)});
        path.push_back({time += 0.8, top + vec3(0, tip - 0.010f, 0.02f)});
        path.push_back({time += 0.3, top + vec3(0, tip - 0.006f, 0.02f)});
    }
    return path;
}

void measure(int nodes, int threads, int count, double seconds, Timings& timings) {
    Experiment experiment(subject(nodes, threads));
    const Mesh& surface = experiment.models().models[0].surface;
    std::vector<std::unique_ptr<FeltHand>> hands;
    std::vector<FeltHand*> all;
    for (int h = 0; h < count; ++h) {
        Path path = pressing(surface, h == 0 ? 0.03f : -0.03f);
        const vec3 start = path.front().position;
        hands.push_back(
            std::make_unique<FeltHand>(std::make_unique<VirtualHand>(std::move(path)),
                                       TouchSettings{.radius = tip, .feels = {{.stiffness = 400}}}, start));
        hands.back()->go_live();
        all.push_back(hands.back().get());
    }
    LiveTouch live(experiment, all);
    live.go_on();
    sleep_until(now() + warm_up);
    live.hold_still();
    const double start = now(), simulated = experiment.time();
    const auto before = live.advances();
    double force = 0, looks = 0;
    while (now() < start + seconds) {
        live.go_on();
        sleep_until(now() + 0.1);
        live.hold_still();
        force += double(glm::length(all[0]->touch().felt().force));
        ++looks;
    }
    const double passed = now() - start;
    const LoopTiming& loop = hands[0]->loop().timing();
    const std::string row =
        fmt::format("{} hand{}, {} nodes, {} thread{}", count, count > 1 ? "s" : "",
                    experiment.models().models[0].body.count(), threads, threads > 1 ? "s" : "");
    auto add = [&](const char* column, double value) {
        timings.figures.push_back({Cell{"live", row, column}.name(), value});
    };
    add("vertices", double(surface.positions.size()));
    add("slices a second", double(live.advances() - before) / passed);
    add("pace", (experiment.time() - simulated) / passed);
    add("slice p50, ms", 1000 * live.lengths().quantile(0.5));
    add("p99, ms", 1000 * live.lengths().quantile(0.99));
    add("work p50, ms", 1000 * live.work().quantile(0.5));
    add("work p99, ms", 1000 * live.work().quantile(0.99));
    add("ticks a second", 1 / loop.periods.mean());
    add("period p99.9, ms", 1000 * loop.periods.quantile(0.999));
    add("mean force, N", force / looks);
}

Timings run(int rounds) {
    Timings timings;
    for (int count : {1, 2})
        for (const auto& [nodes, threads] : sizes)
            measure(nodes, threads, count, rounds * seconds_a_round, timings);
    timings.driver = fmt::format("{}.", kernel());
    timings.figures.push_back({"seconds_each", rounds * seconds_a_round});
    return timings;
}

std::string text(const Timings& timings) {
    Outline outline;
    for (const auto& one : timings.figures)
        if (one.name.starts_with("live / ")) outline.add(cell_of(one.name));
    std::string text = fmt::format(
        "{}\n\nA virtual hand presses the top of the brain (tissue of 1.64 kPa) 10 mm deep and strokes it, "
        "for {} s "
        "a line; nothing is drawn. The body is simulated on one or two threads, in slices as short as the "
        "machine "
        "affords; *pace* is simulated over real time.\n\n",
        timings.driver, timings.figures.back().value);
    std::vector<std::string> cells{""};
    cells.insert(cells.end(), outline.columns.begin(), outline.columns.end());
    text += head(cells);
    for (const std::string& of : outline.rows) {
        cells = {of};
        for (const std::string& column : outline.columns) {
            const std::string name = Cell{"live", of, column}.name();
            const auto found = std::ranges::find(timings.figures, name, &Timings::Figure::name);
            cells.push_back(fmt::format("{:.4g}", found == timings.figures.end() ? NAN : found->value));
        }
        text += row(cells);
    }
    return text;
}

}  // namespace

Benchmark live() {
    return {"live", "a hand that presses the body that it feels, in real time", false, run, text};
}

}  // namespace palpate::speed
