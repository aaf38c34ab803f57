#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/pipe.h"
#include "palpate/body/cloth.h"
#include "palpate/gl/context.h"
#include "palpate/render/renderer.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/solver.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/loop.h"
#include "palpate/viewer/show.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

namespace {

using namespace palpate;
using Json = nlohmann::ordered_json;

// A limit of the driver: what is needed of it (0: it is only reported) and what was found.
struct Need {
    std::string of;
    long needed, found;
};

// What was found out about one part.
struct Finding {
    std::string part;
    std::string found;  // in words
    std::vector<Need> needs = {};
    std::string problem = {};  // with its remedy; empty if there is none
};

// The message of the Error that an attempt throws; empty if it throws none.
template <class Try>
std::string problem_of(const Try& attempt) {
    try {
        attempt();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

// Names the first limit that is too low.
std::string shortage(const std::vector<Need>& needs) {
    for (const Need& need : needs)
        if (need.found < need.needed)
            return fmt::format("{} {} are not enough; update the graphics card's driver, or use another card",
                               need.found, need.of);
    return {};
}

// What the shaders of palpate/solver_gl bind.
std::vector<Need> needs(Backend backend, const gl::Limits& has) {
    constexpr long texels = 18 * 20'000;  // 18 springs for each of 20,000 nodes
    const Need compute_buffers{"storage buffers in compute shaders", 4, has.compute_storage_buffers};
    switch (backend) {
        case Backend::feedback:
            return {{"transform feedback buffers", 4, has.captured_buffers},
                    {"textures in vertex shaders", 9, has.vertex_textures},
                    {"texels of a buffer texture", texels, has.buffer_texels},
                    compute_buffers};
        case Backend::fragment:
            return {{"float colour attachments", 4, has.float_targets},
                    {"textures in fragment shaders", 15, has.fragment_textures},
                    {"texels along a side of a texture", 1024, has.texture_side},
                    compute_buffers};
        case Backend::compute:
            return {compute_buffers,
                    {"textures in compute shaders", 15, has.compute_textures},
                    {"texels of a buffer texture", texels, has.buffer_texels},
                    {"invocations of a work group", 64, has.group},
                    {"bytes of shared memory of a work group", 0, has.shared_bytes}};
        default:
            return {};
    }
}

// Moves a small cloth by one step.
void try_out(Backend backend, const gl::Context* context) {
    const Body body = cloth(ivec2(5, 4), 0.01f, {.density = 0.15f, .damping = 2});
    const auto solver = make_solver(body, {.backend = backend}, context);
    if (!solver)
        throw Error("no such backend in this build", std::string(name_of(backend)),
                    "choose another, or build a newer Palpate");
    if (solver->step(1e-4).diverged)
        throw Error("a step that blew up", std::string(name_of(backend)), "update the driver");
}

Finding look_at(Backend backend, const std::optional<gl::Context>& context) {
    Finding finding{std::string(name_of(backend)), "needs nothing"};
    if (backend == Backend::cpu)
        finding.found = fmt::format("{}, {} cores", cpu_instructions(), std::thread::hardware_concurrency());
    finding.needs = needs(backend, context ? context->limits() : gl::Limits());
    if (!finding.needs.empty()) {
        finding.found = "a step on the GPU";
        finding.problem = context ? shortage(finding.needs) : "needs OpenGL 4.5";
    }
    if (finding.problem.empty())
        finding.problem = problem_of([&] { try_out(backend, context ? &*context : nullptr); });
    return finding;
}

Finding look_at_mapping(const std::optional<gl::Context>& context) {
    Finding finding{"mapping", "surfaces mapped in the vertex shader"};
    if (!context) {
        finding.problem = "needs OpenGL 4.5";
        return finding;
    }
    const gl::Limits has = context->limits();
    finding.needs = {{"storage buffers in vertex shaders", 3, has.vertex_storage_buffers},
                     {"storage buffers in compute shaders", 6, has.compute_storage_buffers},
                     {"bytes of a storage buffer", 16 << 20, has.storage_bytes}};
    finding.problem = shortage(finding.needs);
    if (finding.problem.empty())
        finding.problem = problem_of([&] { Renderer({64, 64}, &*context).draw({}); });
    return finding;
}

// Runs the haptic loop for a second with a hand that touches nothing.
Finding look_at_haptics() {
    constexpr double late = 0.002;  // s, two ticks: a device notices
    Touch hand(std::make_unique<Script>(Path{{0, vec3(0)}}), {});
    TouchLoop loop({&hand});
    sleep_until(now() + 1);
    const LoopTiming& timing = loop.timing();
    const Granted granted = loop.granted();
    Finding finding{"haptics",
                    fmt::format("{:.0f} ticks in a second; period p99.9 {:.2f} ms, longest {:.2f} ms; "
                                "granted: {}, memory {}",
                                double(timing.periods.count()), 1e3 * timing.periods.quantile(0.999),
                                1e3 * timing.periods.longest(), granted.schedule,
                                granted.memory_locked ? "locked" : "not locked")};
    if (!(timing.periods.quantile(0.99) <= late))
        finding.problem = fmt::format(
            "{}; give the user real-time priority (rtprio 90 and memlock unlimited in "
            "/etc/security/limits.conf), or leave a core free",
            finding.found);
    return finding;
}

Finding look_at_window() { return {"window", "a display", {}, problem_of(check_window)}; }

Finding look_at_films() {
    if (has_program("ffmpeg")) return {"films", "the program ffmpeg"};
    return {"films", "", {}, "--video needs the program ffmpeg; install it, or use --images"};
}

Finding look_at_data() {
    const char* folder = std::getenv("PALPATE_DATA");
    if (!folder || !*folder)
        return {
            "data",
            "",
            {},
            "PALPATE_DATA is not set, which the scenes heart and dragon need; run scripts/get-data FOLDER "
            "and export PALPATE_DATA=FOLDER"};
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        return {"data",
                "",
                {},
                fmt::format("PALPATE_DATA={0} is not a folder; run scripts/get-data {0}", folder)};
    return {"data", folder};
}

struct Diagnosis {
    Json driver;  // null if there is none
    std::vector<Finding> findings;
};

Diagnosis diagnose() {
    Diagnosis all;
    // First, because a window's context and a headless one conflict on one thread.
    const Finding window = look_at_window();
    std::optional<gl::Context> context;
    Finding opengl{"opengl", "", {}, problem_of([&] { context.emplace(); })};
    if (context) {
        opengl.found = fmt::format(
            "{}, {}, on {}", context->renderer(), context->version(),
            context->software() ? "the CPU (a software driver: correct but slow)" : "a graphics card");
        all.driver = {{"renderer", context->renderer()},
                      {"version", context->version()},
                      {"vendor", context->vendor()},
                      {"egl", context->egl()},
                      {"software", context->software()}};
    }
    all.findings.push_back(opengl);
    for (const auto& backend : names(Backend{})) all.findings.push_back(look_at(backend.value, context));
    all.findings.push_back(look_at_mapping(context));
    all.findings.push_back(look_at_haptics());
    all.findings.push_back(window);
    all.findings.push_back(look_at_films());
    all.findings.push_back(look_at_data());
    return all;
}

Json described(const Diagnosis& all) {
    Json json{{"driver", all.driver}};
    for (const Finding& one : all.findings) {
        Json needs = Json::array();
        for (const Need& need : one.needs)
            needs.push_back({{"of", need.of}, {"needed", need.needed}, {"found", need.found}});
        json[one.part] = {
            {"ok", one.problem.empty()}, {"found", one.found}, {"needs", needs}, {"problem", one.problem}};
    }
    return json;
}

void print(const Diagnosis& all) {
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Finding& one : all.findings) {
        rows.emplace_back(one.part, one.problem.empty() ? "ok: " + one.found : "no: " + one.problem);
        if (all.driver.is_null()) continue;
        for (const Need& need : one.needs) {
            const std::string wanted =
                need.needed > 0 ? fmt::format(" ({} needed)", grouped(need.needed)) : "";
            rows.emplace_back("", fmt::format("    {} {}{}", grouped(need.found), need.of, wanted));
        }
    }
    print_table(rows);
}

}  // namespace

void add_doctor(CLI::App& app) {
    auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("doctor", "Check this machine for what Palpate needs");
    command->add_flag("--json", *json, "as JSON");
    command->callback([json] {
        const Diagnosis all = diagnose();
        if (*json)
            fmt::print("{}\n", described(all).dump(2));
        else
            print(all);
    });
}
