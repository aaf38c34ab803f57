#include "palpate/run/run.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/extension.h"
#include "palpate/files/sequence.h"
#include "palpate/files/write.h"
#include "palpate/gl/context.h"
#include "palpate/run/contacts.h"
#include "palpate/run/film.h"
#include "palpate/run/notes.h"
#include "palpate/run/picture_writer.h"
#include "palpate/run/play.h"
#include "palpate/run/plot.h"
#include "palpate/scene/build.h"
#include "palpate/solver/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

namespace palpate {
namespace {

// ---- outputs at the end ----

void write_nodes(const std::vector<Model>& models, const std::vector<State>& states,
                 const std::filesystem::path& path) {
    std::string text = "body,id,x,y,z,vx,vy,vz\n";
    for (std::size_t m = 0; m < models.size(); ++m)
        for (std::size_t i = 0; i < states[m].positions.size(); ++i) {
            const dvec3 p = states[m].positions[i], v = states[m].velocities[i];
            // {} writes the fewest digits that read back as the same number.
            text += fmt::format("{},{},{},{},{},{},{},{}\n", models[m].body.name, i, p.x, p.y, p.z, v.x, v.y,
                                v.z);
        }
    write_text(path, text);
}

// The file of one skin: if there are several, with the skin's name in it.
std::filesystem::path file_of(std::size_t skin, const Scene& scene, std::filesystem::path path) {
    const std::size_t bodies = scene.bodies.size();
    const std::string& name = skin < bodies ? scene.bodies[skin].name : scene.surfaces[skin - bodies].name;
    if (bodies + scene.surfaces.size() > 1)
        path.replace_filename(path.stem().string() + "-" + name + path.extension().string());
    return path;
}

// The pressure on each vertex of a body, Pa, if contacts are written.
std::vector<float> pressures_of(std::size_t body, const Play& play, const RunSettings& settings) {
    return settings.contacts.empty() ? std::vector<float>() : play.pressures(body);
}

void write_surfaces(const Scene& scene, const Play& play, const RunSettings& settings) {
    const std::vector<Skin>& skins = play.skins();
    for (std::size_t s = 0; s < skins.size(); ++s) {
        std::vector<float> pressures;
        if (s < scene.bodies.size()) pressures = pressures_of(s, play, settings);
        write_mesh({skins[s].positions, skins[s].normals, *skins[s].triangles},
                   file_of(s, scene, settings.surface), {"pressure", pressures});
    }
}

// ---- outputs during the run ----

// The names of a folder's numbered files with this prefix and suffix.
std::vector<std::string> numbered_files(const std::filesystem::path& folder, const std::string& begin,
                                        const std::string& end) {
    std::vector<std::string> names;
    std::error_code error;
    std::filesystem::directory_iterator file(folder.empty() ? "." : folder, error);
    for (; !error && file != std::filesystem::directory_iterator(); file.increment(error)) {
        const std::string name = file->path().filename().string();
        if (!name.starts_with(begin) || !name.ends_with(end) || name.size() <= begin.size() + end.size())
            continue;
        const std::string number = name.substr(begin.size(), name.size() - begin.size() - end.size());
        if (number.size() >= 4 && number.find_first_not_of("0123456789.") == number.npos)
            names.push_back(name);
    }
    return names;
}

// Those of them that are left from an earlier run. They are not removed, because somebody may want to keep
// them.
void look_for_older(const std::filesystem::path& folder, const std::string& begin, const std::string& end,
                    const std::set<std::string>& ours, std::vector<std::string>& notes) {
    std::size_t count = 0;
    std::string one;
    for (const std::string& name : numbered_files(folder, begin, end)) {
        if (ours.contains(name)) continue;
        if (++count == 1 || name < one) one = name;
    }
    if (count > 0)
        notes.push_back(fmt::format("{} older file{} of an earlier run stay{} in {}, such as {}", count,
                                    count == 1 ? "" : "s", count == 1 ? "s" : "",
                                    folder.empty() ? "this folder" : folder.string(), one));
}

// The moving surfaces, each in a sequence of its own.
class MeshSequences {
 public:
    MeshSequences(const RunSettings& settings, const Scene& scene, const Models& made, const Play& play,
                  double duration)
        : settings_(settings) {
        if (settings.sequence.empty()) return;
        const double frames_apart = std::round(std::clamp(settings.sequence_every / frame_seconds, 1.0, 1e9));
        apart_ = frames_apart * frame_seconds;
        const auto frames = std::size_t(std::ceil(duration / frame_seconds - 1e-6));
        for (std::size_t m = 0; m < made.models.size(); ++m) {
            const Mesh& rest = made.models[m].surface;
            paths_.push_back(file_of(m, scene, settings.sequence));
            sequences_.push_back(make_sequence({rest.positions, play.skins()[m].normals, rest.triangles},
                                               paths_.back(), frames / std::size_t(frames_apart) + 1));
        }
    }

    // The first picture is the state before the first step.
    void frame_done(double time, const Play& play) {
        if (time < next_ - 1e-9) return;
        next_ += apart_;
        ++pictures_;
        for (std::size_t m = 0; m < sequences_.size(); ++m) {
            const std::vector<float> pressures = pressures_of(m, play, settings_);
            sequences_[m]->add(time, play.skins()[m].positions, play.skins()[m].normals,
                               {"pressure", pressures});
        }
    }

    void finish(std::vector<std::string>& notes) {
        for (const auto& sequence : sequences_) sequence->finish();
        for (const std::filesystem::path& path : paths_) {
            std::set<std::string> ours;
            for (std::size_t i = 1; i <= pictures_; ++i)
                for (int digits = 4; digits < 10; ++digits)
                    ours.insert(fmt::format("{}-{:0{}}{}", path.stem().string(), i, digits,
                                            path.extension().string()));
            look_for_older(path.parent_path(), path.stem().string() + "-", path.extension().string(), ours,
                           notes);
        }
    }

 private:
    const RunSettings& settings_;
    double apart_ = 0, next_ = 0;  // s
    std::size_t pictures_ = 0;
    std::vector<std::filesystem::path> paths_;
    std::vector<std::unique_ptr<Sequence>> sequences_;
};

// ---- rest ----

// The end of the last path of a scene, s.
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

// Detects when everything is at rest.
class RestWatch {
 public:
    RestWatch(Rest rule, const Scene& scene, const Models& made)
        : rule_(rule), busy_until_(last_of_paths(scene)) {
        for (const Model& model : made.models) {
            before_.push_back(model.body.positions);
            spacings_.push_back(model.body.spacing);
        }
    }

    // Call it after each frame. Before the last path's end nothing counts, since a resting body may still be
    // pushed.
    bool at_rest(double time, double seconds, const Play& play) {
        constexpr double long_enough = 0.5;  // s: a swing is slow for a moment at its turning point, too
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

    // By the displacement of each node in a frame, because momentary speeds contain rounding errors.
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
    double quiet_ = 0;  // s, how long it has been at rest
    std::vector<std::vector<vec3>> before_;
    std::vector<float> spacings_;
};

// The longest duration of a run, and the length of its frames.
struct Pace {
    double duration, frame;  // s
    double step = 0;         // s, of which both are whole multiples; 0: any

    double next(double time) const {
        const double left = duration - time;
        return std::min(frame, step > 0 ? std::round(left / step) * step : left);
    }
};
Pace pace_of(const Scene& scene, const RunSettings& settings, const Play& play) {
    const double step = scene.simulation.step;
    if (settings.steps && step > 0)
        return {double(*settings.steps) * step, std::max(1.0, std::floor(frame_seconds / step + 1e-6)) * step,
                step};
    if (settings.steps)
        return {frame_seconds * double(*settings.steps) / play.steps_per_frame(), frame_seconds};
    if (settings.frames) return {frame_seconds * *settings.frames, frame_seconds};
    return {settings.until_rest == Rest::none ? scene.duration : 10 * scene.duration, frame_seconds};
}

void check_numbers(const RunSettings& settings) {
    auto refuse = [](bool holds, const char* what, const char* remedy) {
        if (!holds) throw Error(what, "the settings of the run", remedy);
    };
    refuse(settings.frames.value_or(0) >= 0 && settings.steps.value_or(0) >= 0,
           "a negative number of frames or steps", "use 0 or more");
    refuse(settings.image_every > 0 && std::isfinite(settings.image_every), "no time between pictures",
           "give seconds above zero");
    refuse(settings.sequence_every >= 0 && std::isfinite(settings.sequence_every),
           "no time between the pictures of a sequence", "give seconds");
}

// Whether a sequence is a single file, with the mesh at rest in it or beside it; other formats are numbered
// files.
bool has_rest_beside(const std::filesystem::path& sequence) {
    return extension(sequence) == ".pc2" || extension(sequence) == ".mdd";
}
bool has_rest_inside(const std::filesystem::path& sequence) { return extension(sequence) == ".glb"; }

// Whether a tool presses a body, so that there are contacts.
bool has_contacts(const Scene& scene) {
    return !scene.bodies.empty() &&
           std::ranges::any_of(scene.tools, [](const ToolRecipe& tool) { return presses_bodies(tool.kind); });
}

// Throws if an output would replace an input.
void check_inputs_stay(const Scene& scene, const RunSettings& settings) {
    const std::vector<std::filesystem::path> inputs = find_files(scene);
    auto check_numbered = [&](const std::filesystem::path& folder, const std::string& begin,
                              const std::string& end) {
        for (const std::string& name : numbered_files(folder, begin, end))
            check_not_input(folder / name, inputs);
    };
    for (const auto* file :
         {&settings.video, &settings.report, &settings.plot, &settings.contacts, &settings.nodes})
        check_not_input(*file, inputs);
    for (std::size_t s = 0; !settings.surface.empty() && s < scene.bodies.size() + scene.surfaces.size(); ++s)
        check_not_input(file_of(s, scene, settings.surface), inputs);
    for (std::size_t m = 0; !settings.sequence.empty() && m < scene.bodies.size(); ++m) {
        std::filesystem::path file = file_of(m, scene, settings.sequence);
        if (has_rest_beside(file) || has_rest_inside(file))
            check_not_input(file, inputs);
        else
            check_numbered(file.parent_path(), file.stem().string() + "-", file.extension().string());
        if (has_rest_beside(file)) check_not_input(file.replace_extension(".obj"), inputs);
    }
    if (!settings.images.empty()) check_numbered(settings.images, scene.name + "-", "s.png");
}

// Checks before the work that all outputs can be written.
void check_outputs(const Scene& scene, const RunSettings& settings) {
    check_numbers(settings);
    if (!settings.plot.empty() && scene.tools.empty())
        throw Error("no tool whose force could be plotted", settings.plot.string(),
                    "use a scene with a [[tool]], or write no plot");
    if (!settings.contacts.empty() && !has_contacts(scene))
        throw Error(
            "no tool that presses a body", settings.contacts.string(),
            "use a scene with a [[body]] and a [[tool]] of kind press or touch, or write no contacts");
    for (const auto* file : {&settings.nodes, &settings.sequence})
        if (!file->empty() && scene.bodies.empty())
            throw Error("no body that moves, whose nodes could be written", file->string(),
                        "use a scene with a [[body]], or write its --surface");
    if (!settings.images.empty()) {
        check_folder(std::filesystem::absolute(settings.images / ".").parent_path().parent_path(),
                     settings.images.string());
        make_folder(settings.images);  // first, since other outputs may be in it
    }
    if (!settings.video.empty()) check_film(settings.video, settings.width, settings.height);
    check_output(settings.report, ".json");
    check_output(settings.plot, ".svg");
    check_output(settings.contacts, ".csv");
    check_output(settings.nodes, ".csv");
    check_output(settings.surface);
    check_output(settings.sequence);
    if (!settings.surface.empty()) check_mesh_name(settings.surface);
    if (!settings.sequence.empty()) check_sequence_name(settings.sequence);
    const bool beside = has_rest_beside(settings.sequence);
    if (!settings.surface.empty() && (beside || has_rest_inside(settings.sequence)) &&
        settings.surface ==
            (beside ? std::filesystem::path(settings.sequence).replace_extension(".obj") : settings.sequence))
        throw Error("the sequence writes a file of this name too", settings.surface.string(),
                    "name one of them differently");
    check_inputs_stay(scene, settings);
}

}  // namespace

Report run(const Scene& scene, const RunSettings& settings, const Progress& progress) {
    const double start = now();
    Report report;
    report.scene = scene.name;
    report.backend = name_of(scene.simulation.backend);
    report.integrator = name_of(scene.simulation.integrator);
    report.threads = scene.simulation.threads;
    check_outputs(scene, settings);

    check_devices(scene);
    const Models made = build(scene, progress);
    report.notes = notes_before(scene, made);
    const auto known_before = std::ptrdiff_t(report.notes.size());
    std::optional<gl::Context> context;  // for a backend on the GPU, and for drawing
    if (on_gpu(made.simulation.backend)) report.renderer = context.emplace().renderer();
    const gl::Context* const shared = context ? &*context : nullptr;
    Play play(scene, made, report, shared, {}, !settings.contacts.empty());
    ContactTable contacts(scene);
    for (std::size_t m = 0; m < made.models.size(); ++m)
        for (std::size_t c = 0; c < made.simulation.colliders.size(); ++c)
            report.bodies[m].held_at_start += held_at_start(scene, made, c, m);
    std::unique_ptr<PictureWriter> show;
    if (!settings.video.empty() || !settings.images.empty()) {
        show = std::make_unique<PictureWriter>(scene, made, settings, shared);
        report.renderer = show->renderer();
    }
    const Pace pace = pace_of(scene, settings, play);
    MeshSequences sequences(settings, scene, made, play, pace.duration);
    report.seconds.build = now() - start;

    RestWatch watch(settings.until_rest, scene, made);
    auto draw = [&] {
        if (show) report.pictures += show->frame_done(report.simulated, play, report.seconds);
        Timed timed(report.seconds.write);
        sequences.frame_done(report.simulated, play);
    };
    draw();
    while (report.simulated < pace.duration - 1e-9 && !report.rest) {
        const double span = pace.next(report.simulated);
        if (!play.advance(report.simulated, span)) {
            report.diverged = true;
            break;
        }
        if (!on_gpu(made.simulation.backend)) play.skins();  // so that its time counts, drawn or not
        if (!settings.contacts.empty()) contacts.add(play.contacts());
        report.simulated += span;
        ++report.frames;
        if (watch.at_rest(report.simulated, span, play)) report.rest = report.simulated;
        draw();
        if (progress) progress("running " + scene.name, report.simulated / pace.duration);
    }
    if (settings.until_rest != Rest::none && !report.rest && !report.diverged)
        report.notes.push_back(fmt::format("not at rest after {:.4g} s", report.simulated));
    if (show) show->finish();
    if (show && !settings.images.empty())
        look_for_older(settings.images, scene.name + "-", "s.png", show->written(), report.notes);
    sequences.finish(report.notes);
    const std::vector<std::string> after = notes_after(scene, made, report, play);
    report.notes.insert(report.notes.begin() + known_before, after.begin(), after.end());

    const std::vector<State> states = play.states();
    for (std::size_t m = 0; m < states.size(); ++m) {
        const Energy e = energy(made.models[m].body, states[m]);
        report.bodies[m].kinetic_energy = e.kinetic;
        report.bodies[m].elastic_energy = e.elastic;
    }
    if (!settings.contacts.empty()) contacts.write(settings.contacts);
    if (!settings.nodes.empty()) write_nodes(made.models, states, settings.nodes);
    if (!settings.surface.empty()) write_surfaces(scene, play, settings);
    if (!settings.plot.empty()) write_plot(report, settings.plot);
    report.seconds.total = now() - start;
    if (!settings.report.empty()) write_report(report, settings.report);
    return report;
}

}  // namespace palpate
