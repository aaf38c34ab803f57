#include "app/commands.h"
#include "bench/speed/speed.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/solver/machine.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <memory>
#include <thread>

namespace {

using namespace palpate;
using namespace palpate::speed;

struct BenchArguments {
    std::vector<std::string> names;
    std::filesystem::path json, plot;
    int rounds = 15;
};

std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "an unnamed processor";
}

nlohmann::json described(const Timings& timings) {
    nlohmann::json limits = nlohmann::json::array(), cases = nlohmann::json::array();
    for (std::size_t t = 0; t < timings.arithmetic.size(); ++t)
        limits.push_back({{"threads", t + 1},
                          {"links_per_second", timings.arithmetic[t].best},
                          {"copy_bytes_per_second", timings.copying[t].best}});
    for (std::size_t c = 0; c < timings.cases.size(); ++c)
        cases.push_back({{"name", timings.cases[c].name},
                         {"threads", timings.cases[c].threads},
                         {"best_per_second", timings.rates[c].best},
                         {"median_per_second", timings.rates[c].median},
                         {"links_each", timings.cases[c].links},
                         {"bytes_moved_each", timings.cases[c].bytes},
                         {"bytes_kept_each", timings.cases[c].memory}});
    nlohmann::json figures = nlohmann::json::object();
    for (const auto& figure : timings.figures) figures[figure.name] = figure.value;
    return {{"limits", limits}, {"cases", cases}, {"figures", figures}, {"driver", timings.driver}};
}

bool is_wanted(const Benchmark& benchmark, const BenchArguments& arguments) {
    const auto& names = arguments.names;
    return names.empty() ? benchmark.by_default : std::ranges::count(names, benchmark.name) > 0;
}

void run_benchmarks(const BenchArguments& arguments) {
    check_output(arguments.json, ".json");  // before the work, not after
    check_output(arguments.plot, ".svg");
    const auto draws = [&](const Benchmark& one) { return one.curves && is_wanted(one, arguments); };
    if (!arguments.plot.empty() && !std::ranges::any_of(benchmarks(), draws))
        throw CLI::ValidationError("--plot", "name a benchmark that has curves: pipeline, touch or tissue");
    const unsigned cores = std::thread::hardware_concurrency();
    fmt::print(
        "Measured on {}, {} core{}, {}; best and median of {} rounds; ratios are of the bests (of the "
        "medians).\n",
        processor_name(), cores, cores == 1 ? "" : "s", cpu_instructions(), arguments.rounds);
    nlohmann::json all;
    std::vector<Panel> panels;
    std::string title;
    for (const Benchmark& benchmark : benchmarks()) {
        if (!is_wanted(benchmark, arguments)) continue;
        const Timings timings = benchmark.run(arguments.rounds);
        fmt::print("\n### {}: {}\n\n{}", benchmark.name, benchmark.about, benchmark.text(timings));
        std::fflush(stdout);
        all[benchmark.name] = described(timings);
        if (!benchmark.curves) continue;
        title += (title.empty() ? "" : "; ") + benchmark.name + ": " + benchmark.about;
        for (Panel& panel : benchmark.curves(timings)) panels.push_back(std::move(panel));
    }
    if (!arguments.plot.empty()) write_plot(title, panels, arguments.plot);
    if (!arguments.json.empty()) {
        all["processor"] = processor_name();
        all["cores"] = cores;
        all["instructions"] = cpu_instructions();
        write_text(arguments.json, all.dump(2) + "\n");
    }
}

}  // namespace

void add_bench(CLI::App& app) {
    auto arguments = std::make_shared<BenchArguments>();
    CLI::App* command = app.add_subcommand("bench", "Time Palpate against the limits of this machine");
    std::vector<std::string> names;
    for (const Benchmark& benchmark : benchmarks()) names.push_back(benchmark.name);
    command->add_option("names", arguments->names, "which to run [lattice, cloth, embed]")
        ->check(CLI::IsMember(names));
    command
        ->add_option("--rounds", arguments->rounds,
                     "how many times each case runs, interleaved with the others")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--json", arguments->json, "write the figures as JSON");
    command->add_option("--plot", arguments->plot, "write the curves of pipeline, touch or tissue as SVG");
    command->callback([arguments] { run_benchmarks(*arguments); });
}
