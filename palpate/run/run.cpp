#include "palpate/run/run.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"
#include "palpate/mesh/sequence.h"
#include "palpate/mesh/write.h"
#include "palpate/run/play.h"
#include "palpate/run/plot.h"
#include "palpate/run/show.h"
#include "palpate/scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace palpate {
namespace {

// ---- what is written at the end ----

void write_nodes(const std::vector<Model>& models, const std::vector<State>& states,
                 const std::filesystem::path& path) {
    std::string text = "body,id,x,y,z,vx,vy,vz\n";
    for (std::size_t m = 0; m < models.size(); ++m)
        for (std::size_t i = 0; i < states[m].positions.size(); ++i) {
            const dvec3 p = states[m].positions[i], v = states[m].velocities[i];
            // {} writes the shortest digits that read back as the same number.
            text += fmt::format("{},{},{},{},{},{},{},{}\n", models[m].body.name, i, p.x, p.y, p.z, v.x, v.y,
                                v.z);
        }
    write_text(path, text);
}

// The file of one skin: where there are several, its name is in the file's.
std::filesystem::path file_of(std::size_t skin, const Models& made, std::filesystem::path path) {
    const std::size_t models = made.models.size();
    const std::string& name = skin < models ? made.models[skin].body.name : made.stills[skin - models].name;
    if (models + made.stills.size() > 1)
        path.replace_filename(path.stem().string() + "-" + name + path.extension().string());
    return path;
}

void write_surfaces(const Models& made, const std::vector<Skin>& skins, const std::filesystem::path& path) {
    for (std::size_t s = 0; s < skins.size(); ++s)
        write_mesh({skins[s].positions, skins[s].normals, *skins[s].triangles}, file_of(s, made, path));
}

// ---- what is written on the way ----

// The surfaces as they move, each in a sequence of its own.
class MeshSequences {
 public:
    MeshSequences(const RunSettings& settings, const Models& made, const Play& play, double duration) {
        if (settings.sequence.empty()) return;
        if (made.models.empty())
            throw Error("no body whose motion could be recorded", settings.sequence.string(),
                        "use --surface, or a scene with a [[body]]");
        frames_apart_ = int(std::lround(std::clamp(settings.sequence_every / frame_seconds, 1.0, 1e9)));
        const auto frames = std::size_t(std::ceil(duration / frame_seconds - 1e-6));
        for (std::size_t m = 0; m < made.models.size(); ++m) {
            const Mesh& rest = made.models[m].surface;
            sequences_.push_back(make_sequence({rest.positions, play.skins()[m].normals, rest.triangles},
                                               file_of(m, made, settings.sequence),
                                               frames / std::size_t(frames_apart_) + 1));
        }
    }

    // Frame 0 is the state before the first step.
    void frame_done(int number, double time, const Play& play) {
        if (number % frames_apart_ != 0) return;
        for (std::size_t m = 0; m < sequences_.size(); ++m)
            sequences_[m]->add(time, play.skins()[m].positions, play.skins()[m].normals);
    }

    void finish() {
        for (const auto& sequence : sequences_) sequence->finish();
    }

 private:
    int frames_apart_ = 1;
    std::vector<std::unique_ptr<Sequence>> sequences_;
};

// ---- rest ----

// When the last path of a scene has come to its end, s.
double last_of_paths(const Scene& scene) {
    double last = 0;
    auto look_at = [&](const Path& path) {
        if (!path.empty()) last = std::max(last, path.back().time);
    };
    look_at(scene.wind);
    for (const ColliderRecipe& collider : scene.colliders) look_at(collider.path);
    for (const MoveRecipe& move : scene.moves) look_at(move.path);
    for (const ToolRecipe& tool : scene.tools) look_at(tool.path);
    return last;
}

// Watches for the moment when everything is at rest.
class RestWatch {
 public:
    RestWatch(Rest rule, const Scene& scene, const Models& made)
        : rule_(rule), busy_until_(last_of_paths(scene)) {
        for (const Model& model : made.models) {
            before_.push_back(model.body.positions);
            spacings_.push_back(model.body.spacing);
        }
    }

    // After each frame. Before the last path's end nothing counts: what rests may yet be pushed.
    bool at_rest(double time, double seconds, const Play& play) {
        constexpr double long_enough = 0.5;  // s: a swing that turns back is slow for a moment too
        if (rule_ == Rest::none) return false;
        const bool all = rule_ == Rest::move ? small_moves(play) : slow(seconds, play);
        quiet_ = all && time - seconds >= busy_until_ - 1e-9 ? quiet_ + seconds : 0;
        return quiet_ >= (rule_ == Rest::move ? seconds : long_enough) - 1e-9;
    }

 private:
    static bool small_moves(const Play& play) {
        return std::all_of(play.stats().begin(), play.stats().end(),
                           [](const Stats& stats) { return stats.largest_move < 0.001; });
    }

    // By the way of each node from frame to frame: its speed at a moment is partly the rounding of floats.
    bool slow(double seconds, const Play& play) {
        bool all = true;
        for (std::size_t m = 0; m < before_.size(); ++m) {
            const auto now = play.nodes(m).positions;
            const float way = spacings_[m] / 1000 * float(seconds / frame_seconds);
            for (std::size_t i = 0; i < now.size(); ++i) all &= glm::distance(now[i], before_[m][i]) <= way;
            before_[m].assign(now.begin(), now.end());
        }
        return all;
    }

    Rest rule_;
    double busy_until_;
    double quiet_ = 0;  // s, for so long it has been at rest
    std::vector<std::vector<vec3>> before_;
    std::vector<float> spacings_;
};

double longest(const Scene& scene, const RunSettings& settings, const Play& play) {
    if (settings.steps) return frame_seconds * double(*settings.steps) / play.steps_per_frame();
    if (settings.frames) return frame_seconds * *settings.frames;
    return settings.until_rest == Rest::none ? scene.duration : 10 * scene.duration;
}

// Says before the work what could not be written after it.
void check_outputs(const RunSettings& settings) {
    for (const auto* file : {&settings.video, &settings.report, &settings.plot, &settings.nodes,
                             &settings.surface, &settings.sequence}) {
        if (file->has_parent_path()) make_folder(file->parent_path());
        if (std::error_code error; std::filesystem::is_directory(*file, error))
            throw Error("a folder where a file is to be written", file->string(), "name a file");
    }
    if (!settings.surface.empty()) check_mesh_name(settings.surface);
    if (!settings.sequence.empty()) check_sequence_name(settings.sequence);
}

}  // namespace

Report run(const Scene& scene, const RunSettings& settings, const Progress& progress) {
    const double start = now();
    Report report;
    report.scene = scene.name;
    report.backend = name_of(scene.simulation.backend);
    report.integrator = name_of(scene.simulation.integrator);
    report.threads = scene.simulation.threads;
    check_outputs(settings);

    const Models made = build(scene, progress);
    report.notes = made.notes;
    std::optional<gl::Context> context;  // in which a GPU moves the bodies, and pictures are drawn
    if (on_gpu(made.simulation.backend)) report.renderer = context.emplace().renderer();
    const gl::Context* const shared = context ? &*context : nullptr;
    Play play(scene, made, report, shared);
    std::unique_ptr<Show> show;
    if (!settings.video.empty() || !settings.images.empty()) {
        show = std::make_unique<Show>(scene, made, settings, shared);
        report.renderer = show->renderer();
    }
    const double duration = longest(scene, settings, play);
    MeshSequences sequences(settings, made, play, duration);
    report.seconds.build = now() - start;

    RestWatch watch(settings.until_rest, scene, made);
    auto draw = [&] {
        if (show) report.pictures += show->frame_done(report.frames, play, report.seconds);
        Timed timed(report.seconds.write);
        sequences.frame_done(report.frames, report.simulated, play);
    };
    draw();
    while (report.simulated < duration - 1e-9 && !report.rest) {
        const double span = std::min(frame_seconds, duration - report.simulated);
        if (!play.advance(report.simulated, span)) {
            report.diverged = true;
            break;
        }
        report.simulated += span;
        ++report.frames;
        if (watch.at_rest(report.simulated, span, play)) report.rest = report.simulated;
        draw();
        if (progress) progress("running " + scene.name, report.simulated / duration);
    }
    if (settings.until_rest != Rest::none && !report.rest && !report.diverged)
        report.notes.push_back(fmt::format("not at rest after {:.4g} s", report.simulated));
    if (show) show->finish();
    sequences.finish();

    for (const Report::Body& body : report.bodies)
        if (body.inverted_cells > 0)
            report.notes.push_back(fmt::format(
                "body {}: up to {} of {} cells were inside out; press less hard, or use more nodes",
                body.name, body.inverted_cells, body.cells));

    const std::vector<State> states = play.states();
    for (std::size_t m = 0; m < states.size(); ++m) {
        const Energy e = energy(made.models[m].body, states[m]);
        report.bodies[m].kinetic_energy = e.kinetic;
        report.bodies[m].elastic_energy = e.elastic;
    }
    if (!settings.nodes.empty()) write_nodes(made.models, states, settings.nodes);
    if (!settings.surface.empty()) write_surfaces(made, play.skins(), settings.surface);
    if (!settings.plot.empty()) write_plot(report, settings.plot);
    report.seconds.total = now() - start;
    if (!settings.report.empty()) write_report(report, settings.report);
    return report;
}

}  // namespace palpate
