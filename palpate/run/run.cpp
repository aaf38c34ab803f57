#include "palpate/run/run.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"
#include "palpate/mesh/write.h"
#include "palpate/render/renderer.h"
#include "palpate/run/film.h"
#include "palpate/run/plot.h"
#include "palpate/run/tip.h"
#include "palpate/scene/build.h"
#include "palpate/solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace palpate {
namespace {

constexpr double frame = 1.0 / 60;     // s
constexpr int frames_per_picture = 2;  // of a film: 30 pictures a second

// ---- pictures ----

// Draws the scene as it moves, into a film and single pictures.
class Show {
 public:
    Show(const Scene& scene, const std::vector<Model>& models, const RunSettings& settings)
        : scene_(scene), models_(models), settings_(settings), renderer_({settings.width, settings.height}) {
        for (const Model& model : models) meshes_.push_back(renderer_.add(model.surface));
        if (!settings.video.empty())
            film_ = std::make_unique<Film>(settings.video, settings.width, settings.height,
                                           60 / frames_per_picture);
        if (!settings.images.empty()) make_folder(settings.images);
        if (settings.lattice)
            for (const Model& model : models) springs_.push_back(spring_ends(model.body));
        camera_ = scene.camera;
        camera_.look_at = looked_at();
    }

    const std::string& renderer() const { return renderer_.context().renderer(); }

    // Frame 0 is the state before the first step. Returns whether it drew.
    bool frame_done(int number, const std::vector<Skin>& skins,
                    const std::vector<std::unique_ptr<Solver>>& solvers,
                    const std::vector<std::optional<Press>>& presses) {
        const bool film_wants = film_ && number % frames_per_picture == 0;
        const bool images_want = !settings_.images.empty() && number * frame >= next_image_ - 1e-9;
        if (!film_wants && !images_want) return false;
        renderer_.draw(picture(skins, solvers, presses));
        const Image image = renderer_.image();
        if (film_wants) film_->add(image);
        if (images_want) {
            write_png(image, settings_.images / fmt::format("{}-{:05.2f}s.png", scene_.name, number * frame));
            next_image_ += settings_.image_every;
        }
        return true;
    }

    void finish() {
        if (film_) film_->finish();
    }

 private:
    vec3 looked_at() const {
        if (const auto* point = std::get_if<vec3>(&scene_.look_at)) return *point;
        for (const Model& model : models_)
            if (model.body.name == std::get<std::string>(scene_.look_at))
                return bounds(model.surface).centre();
        return vec3(0);
    }

    Picture picture(const std::vector<Skin>& skins, const std::vector<std::unique_ptr<Solver>>& solvers,
                    const std::vector<std::optional<Press>>& presses) const {
        Picture picture;
        picture.camera = camera_;
        picture.light = scene_.light;
        for (std::size_t m = 0; m < models_.size(); ++m) {
            const BodyRecipe& recipe = scene_.bodies[m];
            picture.surfaces.push_back(
                {meshes_[m], skins[m].positions, skins[m].normals, {recipe.colour, recipe.shine}});
            if (settings_.lattice) picture.wires.push_back({solvers[m]->nodes().positions, springs_[m], {}});
        }
        for (std::size_t t = 0; t < presses.size(); ++t)
            if (presses[t])
                picture.balls.push_back({presses[t]->centre, presses[t]->radius, scene_.tools[t].colour});
        for (const Collider& collider : scene_.simulation.colliders)
            if (const auto* plane = std::get_if<Plane>(&collider.shape))
                picture.grounds.push_back({plane->normal, plane->offset});
            else if (const auto* sphere = std::get_if<Sphere>(&collider.shape))
                picture.balls.push_back({sphere->centre, sphere->radius, vec3(0.5f)});
        return picture;
    }

    const Scene& scene_;
    const std::vector<Model>& models_;
    const RunSettings& settings_;
    Renderer renderer_;
    Camera camera_;
    std::vector<int> meshes_;
    std::vector<std::vector<uvec2>> springs_;
    std::unique_ptr<Film> film_;
    double next_image_ = 0;
};

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

void write_surfaces(const std::vector<Model>& models, const std::vector<Skin>& skins,
                    const std::filesystem::path& path) {
    for (std::size_t m = 0; m < models.size(); ++m) {
        const Mesh mesh{skins[m].positions, skins[m].normals, models[m].surface.triangles};
        std::filesystem::path file = path;
        if (models.size() > 1)
            file.replace_filename(path.stem().string() + "-" + models[m].body.name +
                                  path.extension().string());
        write_mesh(mesh, file);
    }
}

Report::Body describe(const Model& model) {
    Report::Body body;
    body.name = model.body.name;
    body.nodes = model.body.count();
    body.pinned =
        std::size_t(std::count(model.body.inverse_mass.begin(), model.body.inverse_mass.end(), 0.0f));
    body.springs = spring_ends(model.body).size();
    body.cells = model.body.cells.size();
    body.vertices = model.surface.positions.size();
    body.faces = model.surface.triangles.size();
    body.spacing = model.body.spacing;
    body.mass = mass(model.body);
    body.volume = volume(model.surface);
    return body;
}

// ---- the run ----

// A scene in motion: a solver and a skin for each body, a tip for each tool.
class Play {
 public:
    Play(const Scene& scene, const std::vector<Model>& models, Report& report)
        : scene_(scene), models_(models), report_(report), skins_(models.size()) {
        for (const Model& model : models) {
            Simulation simulation = scene.simulation;
            simulation.frame = frame;
            for (const ToolRecipe& tool : scene.tools)
                simulation.contact += pressure_per_metre(as_press(tool));
            solvers_.push_back(make_solver(model.body, simulation));
            report.bodies.push_back(describe(model));
            for (const ToolRecipe& tool : scene.tools)
                if (tool.radius < 0.7f * model.body.spacing)
                    report.notes.push_back(
                        fmt::format("tool {}: its tip is finer than the lattice of body {} and may fall "
                                    "between the nodes; use more nodes",
                                    tool.name, model.body.name));
        }
        for (const ToolRecipe& tool : scene.tools) {
            tips_.emplace_back(tool);
            report.tools.emplace_back().name = tool.name;
        }
        presses_.resize(tips_.size());
        for (std::size_t m = 0; m < models.size(); ++m) skins_[m].triangles = &models[m].surface.triangles;
        map();
    }

    const std::vector<Skin>& skins() const { return skins_; }
    const std::vector<std::unique_ptr<Solver>>& solvers() const { return solvers_; }
    const std::vector<std::optional<Press>>& presses() const { return presses_; }

    // Steps that the busiest body takes for a frame.
    int steps_per_frame() const {
        double shortest = frame;
        for (const auto& solver : solvers_) shortest = std::min(shortest, solver->longest_step({}));
        return steps_within(frame, shortest);
    }

    // Simulates and maps `seconds` from `time` on. False if a body diverged, which is then as it was before.
    bool advance(double time, double seconds) {
        std::vector<Press> pressing;
        std::vector<std::size_t> tool_of;  // each press
        for (std::size_t t = 0; t < tips_.size(); ++t) {
            presses_[t] = tips_[t].press(time, seconds, skins_);
            if (!presses_[t]) continue;
            pressing.push_back(*presses_[t]);
            tool_of.push_back(t);
        }
        std::vector<dvec3> impulses(pressing.size(), dvec3(0));
        bool sound = true;
        {
            Timed timed(report_.seconds.simulate);
            for (std::size_t m = 0; m < solvers_.size(); ++m) sound &= move(m, seconds, pressing, impulses);
        }
        if (!sound) return false;
        map();
        std::vector<double> forces(tips_.size(), 0);
        for (std::size_t p = 0; p < pressing.size(); ++p)
            forces[tool_of[p]] = glm::length(impulses[p]) / seconds;
        for (std::size_t t = 0; t < tips_.size(); ++t) record(t, time + seconds, forces[t]);
        return true;
    }

    std::vector<State> states() const {
        std::vector<State> states;
        for (const auto& solver : solvers_) states.push_back(solver->state());
        return states;
    }

 private:
    static Press as_press(const ToolRecipe& tool) { return {{}, {}, tool.radius, tool.stiffness}; }

    bool move(std::size_t m, double seconds, const std::vector<Press>& pressing,
              std::vector<dvec3>& impulses) {
        const Stats stats = solvers_[m]->step(seconds, {.presses = pressing});
        if (stats.diverged) {
            report_.notes.push_back(
                fmt::format("body {} diverged with steps of {:.4g} s", models_[m].body.name, stats.step));
            return false;
        }
        for (std::size_t p = 0; p < pressing.size(); ++p) impulses[p] += stats.reactions[p];
        Report::Body& body = report_.bodies[m];
        body.steps += stats.steps;
        if (body.step == 0 || stats.step < body.step) body.step = stats.step;
        body.largest_speed = std::max(body.largest_speed, stats.largest_speed);
        body.inverted_cells =
            std::max(body.inverted_cells, inverted_cells(models_[m].body, solvers_[m]->nodes().positions));
        return true;
    }

    void map() {
        Timed timed(report_.seconds.map);
        for (std::size_t m = 0; m < models_.size(); ++m)
            deform(models_[m].embedding, solvers_[m]->nodes(), skins_[m].positions, skins_[m].normals);
    }

    void record(std::size_t t, double time, double force) {
        if (presses_[t])
            presses_[t]->centre = tips_[t].centre(time);  // where it is now, for whoever draws it
        const double depth = presses_[t] ? tips_[t].indentation(presses_[t]->centre, skins_) : 0;
        Report::Tool& tool = report_.tools[t];
        tool.largest_force = std::max(tool.largest_force, force);
        tool.deepest_indentation = std::max(tool.deepest_indentation, depth);
        tool.time.push_back(time);
        tool.force.push_back(force);
        tool.indentation.push_back(depth);
    }

    const Scene& scene_;
    const std::vector<Model>& models_;
    Report& report_;
    std::vector<std::unique_ptr<Solver>> solvers_;
    std::vector<Skin> skins_;
    std::vector<Tip> tips_;
    std::vector<std::optional<Press>> presses_;  // of the last frame, one a tool
};

// Says before the work what could not be written after it.
void check_outputs(const RunSettings& settings) {
    for (const auto* file :
         {&settings.video, &settings.report, &settings.plot, &settings.nodes, &settings.surface}) {
        if (file->has_parent_path()) make_folder(file->parent_path());
        if (std::error_code error; std::filesystem::is_directory(*file, error))
            throw Error("a folder where a file is to be written", file->string(), "name a file");
    }
    if (!settings.surface.empty()) check_mesh_name(settings.surface);
}

}  // namespace

Report run(const Scene& scene, const RunSettings& settings, const Progress& progress) {
    const double start = now();
    Report report;
    report.scene = scene.name;
    report.backend = name_of(scene.simulation.backend);
    report.integrator = name_of(scene.simulation.integrator);
    check_outputs(settings);

    const Models made = build(scene, progress);
    report.notes = made.notes;
    Play play(scene, made.models, report);
    std::unique_ptr<Show> show;
    if (!settings.video.empty() || !settings.images.empty()) {
        show = std::make_unique<Show>(scene, made.models, settings);
        report.renderer = show->renderer();
    }
    report.seconds.build = now() - start;

    const double duration = settings.steps    ? frame * double(*settings.steps) / play.steps_per_frame()
                            : settings.frames ? frame * *settings.frames
                                              : scene.duration;
    auto draw = [&] {
        Timed timed(report.seconds.render);
        if (show)
            report.pictures += show->frame_done(report.frames, play.skins(), play.solvers(), play.presses());
    };
    draw();
    while (report.simulated < duration - 1e-9) {
        const double span = std::min(frame, duration - report.simulated);
        if (!play.advance(report.simulated, span)) {
            report.diverged = true;
            break;
        }
        report.simulated += span;
        ++report.frames;
        draw();
        if (progress) progress("running " + scene.name, report.simulated / duration);
    }
    if (show) show->finish();

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
    if (!settings.surface.empty()) write_surfaces(made.models, play.skins(), settings.surface);
    if (!settings.plot.empty()) write_plot(report, settings.plot);
    report.seconds.total = now() - start;
    if (!settings.report.empty()) write_report(report, settings.report);
    return report;
}

}  // namespace palpate
