#include "palpate/run/run.h"

#include "app/choice.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "palpate/base/error.h"
#include "palpate/run/experiment.h"
#include "palpate/run/notes.h"
#include "palpate/viewer/show.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <thread>

namespace {

using namespace palpate;

struct RunArguments {
    std::string scene, backend, integrator, size = "1280x720";
    std::optional<std::string> rest;
    std::vector<Change> changes;
    int threads = 0;  // 0: as the scene says
    bool force = false, headless = false;
    RunSettings settings;
};

// Reads a size, such as "1280x720".
void set_size(const std::string& text, RunSettings& settings) {
    constexpr double most = 16384;
    double width = 0, height = 0;
    int used = 0;
    const int read = std::sscanf(text.c_str(), "%lfx%lf%n", &width, &height, &used);
    if (read != 2 || std::size_t(used) != text.size() || width != std::round(width) ||
        height != std::round(height))
        throw CLI::ValidationError("--size", "write WIDTHxHEIGHT, such as 1280x720");
    if (!(width >= 1 && height >= 1 && width <= most && height <= most))
        throw CLI::ValidationError("--size",
                                   fmt::format("{} is not from 1 to {} pixels each way", text, most));
    settings.width = int(width);
    settings.height = int(height);
}

// Reads the name of a rule; an option without a value means speed.
void set_rest(const std::string& rule, RunSettings& settings) {
    const auto known = rule.empty() ? Rest::speed : value_of<Rest>(rule);
    if (!known || *known == Rest::none) throw CLI::ValidationError("--until-rest", "choose speed or move");
    settings.until_rest = *known;
}

// Of tissue, its cells are what resists.
std::pair<std::string, std::string> nodes_and_links(const Report::Body& body) {
    const bool of_cells = body.springs == 0 && body.cells > 0;
    return {of_cells ? "nodes, cells" : "nodes, springs",
            fmt::format("{}, {}", grouped((long long)body.nodes),
                        grouped((long long)(of_cells ? body.cells : body.springs)))};
}

void print_summary(const Report& report) {
    const double frames = std::max(report.frames, 1);
    auto each = [&](double seconds) {
        return fmt::format("{:6.2f} s   {:7.2f} ms a frame", seconds, 1000 * seconds / frames);
    };
    fmt::print("{}\n", report.scene);
    for (const Report::Body& body : report.bodies)
        if (body.nodes == 0)
            print_table({{"surface", body.name},
                         {"vertices, faces", fmt::format("{}, {}", grouped((long long)body.vertices),
                                                         grouped((long long)body.faces))}});
        else
            print_table({{"body", body.name},
                         nodes_and_links(body),
                         {"vertices, faces", fmt::format("{}, {}", grouped((long long)body.vertices),
                                                         grouped((long long)body.faces))},
                         {"spacing", fmt::format("{:.2f} mm", 1000 * body.spacing)},
                         {"mass", fmt::format("{:.3g} kg free", body.mass)},
                         {"steps", fmt::format("{} of {:.3g} ms", grouped(body.steps), 1000 * body.step)},
                         {"largest speed", fmt::format("{:.3g} m/s", body.largest_speed)}});
    for (const Report::Tool& tool : report.tools)
        print_table({{"tool", tool.name},
                     {"largest force", fmt::format("{:.3g} N", tool.largest_force)},
                     {"deepest indentation", fmt::format("{:.1f} mm", 1000 * tool.deepest_indentation)}});
    print_table({{"solver", fmt::format("{}, {}, {} thread{}", report.backend, report.integrator,
                                        report.threads, report.threads > 1 ? "s" : "")},
                 {"simulated", fmt::format("{:.2f} s in {} frames{}", report.simulated, report.frames,
                                           report.rest ? ", then at rest" : "")},
                 {"build", fmt::format("{:6.2f} s", report.seconds.build)},
                 {"simulate", each(report.seconds.simulate)},
                 {"map", each(report.seconds.map)},
                 {"render",
                  fmt::format("{:6.2f} s   {:7.2f} ms a picture, {} pictures", report.seconds.render,
                              1000 * report.seconds.render / std::max(report.pictures, 1), report.pictures)},
                 {"write", fmt::format("{:6.2f} s   {:7.2f} ms a picture", report.seconds.write,
                                       1000 * report.seconds.write / std::max(report.pictures, 1))},
                 {"total", fmt::format("{:6.2f} s", report.seconds.total)}});
    for (const std::string& note : report.notes) fmt::print("  note: {}\n", note);
}

// Whether the run is to write files or to end by itself, which a window does not do.
bool wants_files(const RunArguments& arguments) {
    const RunSettings& s = arguments.settings;
    for (const auto* file :
         {&s.video, &s.images, &s.report, &s.plot, &s.contacts, &s.nodes, &s.surface, &s.sequence})
        if (!file->empty()) return true;
    return s.frames || s.steps || arguments.rest;
}

// Notes on options that were given without effect.
std::vector<std::string> useless_options(const CLI::App& command, const Scene& scene,
                                         const RunSettings& settings) {
    std::vector<std::string> notes;
    if (settings.video.empty() && settings.images.empty())
        for (const char* option : {"--size", "--lattice"})
            if (command.count(option) > 0)
                notes.push_back(fmt::format("{} changes nothing without --video or --images", option));
    if (command.count("--force") > 0 && !(scene.simulation.step > 0))
        notes.push_back("--force changes nothing where the step is chosen automatically");
    const unsigned cores = std::thread::hardware_concurrency();
    if (cores > 0 && scene.simulation.threads > int(cores))
        notes.push_back(fmt::format("{} threads on {} cores are no faster than {}", scene.simulation.threads,
                                    cores, cores));
    return notes;
}

// Replays a recording, and reports whether the final state is the same.
void replay(const std::string& file) {
    const Recording recording = read_recording(file);
    Experiment experiment(prepare(recording.scene, recording.changes, terminal_progress()));
    end_progress();
    while (experiment.replay(recording)) {}
    const bool same = experiment.fingerprint() == recording.fingerprint;
    fmt::print("{}\n", recording.scene.name);
    print_table({{"advanced", fmt::format("{} times", grouped(recording.advances))},
                 {"inputs", grouped((long long)recording.inputs.size())},
                 {"state at the end", same ? "the same to the bit" : "different"}});
    if (!same)
        throw Error("the state after the last frame differs from the recorded one", file,
                    "replay it on the same backend, with the same files and the same version");
}

void run_scene(RunArguments& arguments, const CLI::App& command) {
    if (!arguments.backend.empty())
        arguments.changes.push_back("simulation.backend=\"" + arguments.backend + "\"");
    if (arguments.threads > 0)
        arguments.changes.push_back(fmt::format("simulation.threads={}", arguments.threads));
    if (!arguments.integrator.empty())
        arguments.changes.push_back("simulation.integrator=\"" + arguments.integrator + "\"");
    set_size(arguments.size, arguments.settings);
    if (arguments.scene.empty() &&
        (arguments.headless || wants_files(arguments) || !arguments.changes.empty()))
        throw CLI::RequiredError("scene");
    if (arguments.rest) set_rest(*arguments.rest, arguments.settings);
    const bool recorded = arguments.scene.ends_with(".json");
    if (recorded && (wants_files(arguments) || !arguments.changes.empty()))
        throw Error("a recording is replayed as it is", arguments.scene,
                    "leave out all options but --headless and --size");
    if (!arguments.headless && !wants_files(arguments))
        return show(arguments.scene, arguments.changes,
                    {{arguments.settings.width, arguments.settings.height}, arguments.settings.lattice});
    if (recorded) return replay(arguments.scene);
    Scene scene = read_scene(arguments.scene, arguments.changes);
    scene.simulation.force = arguments.force;

    Report report = run(scene, arguments.settings, terminal_progress());
    end_progress();
    for (std::string& note : useless_options(command, scene, arguments.settings))
        report.notes.push_back(std::move(note));
    print_summary(report);
    if (report.diverged)
        throw Error(fmt::format("the motion blew up after {:.3f} s", report.simulated), arguments.scene,
                    (scene.simulation.step > 0 ? "use step = \"auto\"" : how_to_ask_less(scene, report)) +
                        "; what was written until then is kept");
}

}  // namespace

void add_run(CLI::App& app) {
    auto arguments = std::make_shared<RunArguments>();
    RunSettings& settings = arguments->settings;
    CLI::App* command =
        app.add_subcommand("run",
                           "Open a scene, a mesh or a volume in a window; or run it off screen "
                           "and write files");
    command->add_option("scene", arguments->scene,
                        "a TOML file, the name of a shipped scene, a mesh, a volume, or a recording (.json) "
                        "[chosen in the window]");
    command->add_flag("--headless", arguments->headless,
                      "run off screen, as with any option that writes a file or sets an end");
    command->add_option("--backend", arguments->backend, "see: palpate list backends");
    command->add_option("--threads", arguments->threads, "threads for simulation and mapping [1]")
        ->check(CLI::Range(1, most_threads));
    command->add_option("--integrator", arguments->integrator, "see: palpate list integrators");
    auto* frames = command->add_option("--frames", settings.frames, "stop after so many frames of 1/60 s");
    auto* steps =
        command
            ->add_option("--steps", settings.steps,
                         "stop after so many steps of the solver; with an automatic step, counted as "
                         "if nothing touched the bodies")
            ->excludes(frames);
    for (auto* count : {frames, steps}) count->check(from_to(0, 1e8));
    command->add_option("--until-rest", arguments->rest, "end at rest, by the rule speed or move [speed]")
        ->expected(0, 1)
        ->excludes(frames)
        ->excludes(steps);
    command->add_option("--size", arguments->size, "size of the window or the pictures, in pixels")
        ->capture_default_str();
    command->add_option("--video", settings.video, "write a film as MP4 (needs ffmpeg)");
    auto* images = command->add_option("--images", settings.images,
                                       "write PNG pictures into this folder, which is made if it is missing");
    command->add_option("--image-every", settings.image_every, "s between those pictures")
        ->needs(images)
        ->check(above_zero())
        ->capture_default_str();
    command->add_option("--report", settings.report, "write figures as JSON");
    command->add_option("--plot", settings.plot, "write force and indentation over time as SVG");
    command->add_option("--contacts", settings.contacts,
                        "write force, place, depth and area of each tool's contacts, each ms, as CSV");
    command->add_option("--nodes", settings.nodes, "write the final nodes as CSV");
    command->add_option("--surface", settings.surface,
                        "write the final surface: .ply, .obj, .stl, .vtp, .glb or .gltf");
    auto* sequence = command->add_option(
        "--sequence", settings.sequence,
        "write the surface as it moves: numbered .ply, .obj, .stl or .vtp, or one .pc2, .mdd or .glb");
    command->add_option("--sequence-every", settings.sequence_every, "s between its frames [1/30]")
        ->needs(sequence)
        ->check(above_zero());
    command->add_flag("--lattice", settings.lattice, "draw the springs over the surface");
    command->add_option("--set", arguments->changes, "change the scene, as in body.brain.nodes=5000")
        ->allow_extra_args(false);
    command->add_flag("--force", arguments->force, "accept a step above the stability bound");
    command->callback([arguments, command] { run_scene(*arguments, *command); });
}
