#include "palpate/run/play.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/mesh/repair.h"
#include "palpate/run/run.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

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
    const bool open = !model.body.faces.empty() && soundness(model.surface).open_edges > 0;
    body.volume = open ? 0 : volume(model.surface);
    body.mended = model.steps;
    return body;
}

// What a cage carries may be open; every other surface that is no cloth encloses a volume.
bool is_sheet(const BodyRecipe& recipe, const Mesh& surface) {
    return recipe.is_cloth() || (recipe.cage && soundness(surface).open_edges > 0);
}

// Where the nodes of a prescribed motion shall be at a time.
std::vector<vec3> places(const MovedNodes& moved, const Path& path, const Body& body, double time) {
    const Pose at = pose(path, time);
    std::vector<vec3> to;
    for (int node : moved.nodes) {
        const vec3 rest = body.positions[std::size_t(node)];
        to.push_back(moved.about + at.position + at.rotation * (rest - moved.about));
    }
    return to;
}

}  // namespace

// On each body: the tips, which all feel, and what is its own.
struct Play::Acting {
    struct OnBody {
        std::vector<Drag> drags;
        std::vector<std::size_t> tool_of_drag;  // the scene's come first; then those of hands,
        std::vector<std::size_t> pull_of_drag;  // one of Hands::pulls each
        std::vector<Move> moves;
    };
    std::vector<Press> presses;
    std::vector<std::size_t> tool_of_press;  // likewise the scene's first
    std::vector<OnBody> bodies;
    std::vector<std::vector<vec3>> places;  // that the moves lead to
    std::vector<Motion> colliders;
    std::size_t pulls = 0;  // of hands, on all bodies
    vec3 wind = vec3(0);
};

Motion motion_between(const Pose& from, const Pose& to, vec3 pivot, double seconds) {
    Motion motion;
    motion.position = pivot + from.position;
    motion.rotation = from.rotation;
    motion.velocity = (to.position - from.position) / float(seconds);
    glm::dquat way = glm::quat_cast(glm::dmat3(to.rotation) * glm::transpose(glm::dmat3(from.rotation)));
    if (way.w < 0) way = -way;
    const dvec3 axis(way.x, way.y, way.z);
    if (const double sine = glm::length(axis); sine > 0)
        motion.spin = vec3(axis / sine * (2 * std::atan2(sine, way.w) / seconds));
    return motion;
}

Play::Play(const Scene& scene, const Models& made, Report& report, const gl::Context* context,
           std::span<const double> frequencies)
    : scene_(scene),
      made_(made),
      report_(report),
      team_(made.simulation.threads),
      skins_(made.models.size() + made.stills.size()),
      tools_(scene.tools.size()) {
    Simulation simulation = made.simulation;
    simulation.frame = frame_seconds;
    for (const Model& model : made.models) {
        const std::size_t m = solvers_.size();
        solvers_.push_back(
            make_solver(model.body, simulation, context, m < frequencies.size() ? frequencies[m] : 0));
        report.bodies.push_back(describe(model));
    }
    for (const Still& still : made.stills) {
        Report::Body& body = report.bodies.emplace_back();
        body.name = still.name;
        body.vertices = still.surface.positions.size();
        body.faces = still.surface.triangles.size();
        body.volume = volume(still.surface);
        body.mended = still.steps;
    }
    for (const ToolRecipe& tool : scene.tools) {
        if (tool.kind == ToolKind::press)
            handles_.emplace_back(Tip(tool, scene.file));
        else if (tool.kind == ToolKind::drag)
            handles_.emplace_back(Grip(tool));
        else
            handles_.emplace_back(Probe(tool, scene));
        probes_ |= tool.kind == ToolKind::dent;
        report.tools.emplace_back().name = tool.name;
    }
    const std::size_t models = made.models.size();
    for (std::size_t m = 0; m < models; ++m) {
        const Mesh& surface = made.models[m].surface;
        skins_[m].triangles = &surface.triangles;
        skins_[m].is_sheet = is_sheet(scene.bodies[m], surface);
    }
    for (std::size_t s = 0; s < made.stills.size(); ++s) {
        const Mesh& surface = made.stills[s].surface;
        skins_[models + s] = {surface.positions, surface.normals, &surface.triangles,
                              is_sheet(scene.surfaces[s], surface)};
    }
    velocities_.resize(skins_.size());
    if (!on_gpu(simulation.backend)) map();
}

const std::vector<Skin>& Play::skins() const {
    if (!mapped_) map();
    return skins_;
}

int Play::steps_per_frame() const {
    double shortest = frame_seconds;
    for (const auto& solver : solvers_) shortest = std::min(shortest, solver->longest_step({}));
    return steps_within(frame_seconds, shortest);
}

std::vector<State> Play::states() const {
    std::vector<State> states;
    for (const auto& solver : solvers_) states.push_back(solver->state());
    return states;
}

std::vector<State> Play::save() const {
    std::vector<State> states;
    for (const auto& solver : solvers_) states.push_back(solver->save());
    return states;
}

void Play::restore(const std::vector<State>& states) {
    for (std::size_t m = 0; m < solvers_.size(); ++m) solvers_[m]->restore(states[m]);
    mapped_ = false;
    before_.clear();  // how fast skins moved is not known any more
    for (auto& velocities : velocities_) velocities.clear();
}

void Play::take_tools(const Play& from) {
    if (from.handles_.size() != handles_.size())
        throw Error("another number of tools", "the scene whose tools are taken over", "give both the same");
    for (std::size_t t = 0; t < handles_.size(); ++t)
        if (const auto* tip = std::get_if<Tip>(&from.handles_[t])) {
            Tip same = *tip;
            same.lies_over(skins());
            handles_[t] = std::move(same);
        } else if (const auto* grip = std::get_if<Grip>(&from.handles_[t])) {
            handles_[t] = *grip;
        }
    tools_ = from.tools_;
    pushes_ = from.pushes_;
    time_ = from.time_;
}

void Play::take_probes(Play& from) {
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        if (!std::holds_alternative<Probe>(from.handles_[t])) continue;
        handles_[t] = std::move(from.handles_[t]);
        std::get<Probe>(handles_[t]).set(feels_of(scene_));
    }
}

std::size_t Play::memory() const {
    std::size_t bytes = 0;
    for (const auto& solver : solvers_) bytes += solver->memory();
    return bytes;
}

std::vector<Motion> Play::colliders(double time, double seconds) const {
    std::vector<Motion> motions(scene_.colliders.size());
    for (std::size_t c = 0; c < motions.size(); ++c)
        if (const Path& path = scene_.colliders[c].path; !path.empty())
            motions[c] =
                motion_between(pose(path, time), pose(path, time + seconds), made_.pivots[c], seconds);
    return motions;
}

std::vector<Dent> Play::dents(std::size_t skin) const {
    std::vector<Dent> all;
    for (const auto& handle : handles_)
        if (const auto* one = std::get_if<Probe>(&handle)) {
            const std::vector<Dent> more = one->dents(int(skin), time_);
            all.insert(all.end(), more.begin(), more.end());
        }
    return all;
}

// The probes feel the surfaces as they are at `time`, and guess how they go on.
void Play::probe(double time, double seconds) {
    if (!probes_) return;
    skins();  // which have their own time
    Timed timed(report_.seconds.simulate);
    const double since = time - before_time_;
    for (std::size_t m = 0; m < made_.models.size(); ++m) {
        const std::vector<vec3>& now = skins_[m].positions;
        if (!before_.empty() && since > 0) {
            velocities_[m].resize(now.size());
            for (std::size_t i = 0; i < now.size(); ++i)
                velocities_[m][i] = (now[i] - before_[m][i]) / float(since);
        }
    }
    before_.resize(made_.models.size());
    for (std::size_t m = 0; m < made_.models.size(); ++m) before_[m] = skins_[m].positions;
    before_time_ = time;
    for (auto& handle : handles_)
        if (auto* one = std::get_if<Probe>(&handle); one && one->is_there(time))
            one->advance(time, seconds, skins_, velocities_, !made_.models.empty());
}

bool Play::advance(double time, double seconds, const Hands& hands) {
    probe(time, seconds);
    const Acting on = acting(time, seconds, hands);
    {
        Timed timed(report_.seconds.simulate);
        if (!step(seconds, on)) return false;
    }
    mapped_ = false;
    time_ = time + seconds;
    if (!on_gpu(made_.simulation.backend)) map();
    record(on, time + seconds, seconds);
    return true;
}

Play::Acting Play::acting(double time, double seconds, const Hands& hands) {
    Acting on;
    on.bodies.resize(solvers_.size());
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        if (auto* tip = std::get_if<Tip>(&handles_[t])) {
            if (!tip->is_there(time)) continue;
            on.presses.push_back(tip->press(time, seconds, skins()));
            on.tool_of_press.push_back(t);
        } else if (auto* grip = std::get_if<Grip>(&handles_[t])) {
            const auto drag = grip->drag(time, seconds, made_.models, solvers_);
            if (!drag) continue;
            on.bodies[grip->body()].drags.push_back(*drag);
            on.bodies[grip->body()].tool_of_drag.push_back(t);
        }
    }
    on.presses.insert(on.presses.end(), hands.presses.begin(), hands.presses.end());
    for (std::size_t p = 0; p < hands.pulls.size(); ++p) {
        Acting::OnBody& body = on.bodies[hands.pulls[p].body];
        body.drags.push_back(hands.pulls[p].drag);
        body.pull_of_drag.push_back(p);
    }
    on.pulls = hands.pulls.size();
    for (std::size_t i = 0; i < made_.moves.size(); ++i) {
        const MovedNodes& moved = made_.moves[i];
        on.places.push_back(
            places(moved, scene_.moves[i].path, made_.models[moved.body].body, time + seconds));
    }
    for (std::size_t i = 0; i < made_.moves.size(); ++i)
        on.bodies[made_.moves[i].body].moves.push_back({made_.moves[i].nodes, on.places[i]});
    on.colliders = colliders(time, seconds);
    if (!scene_.wind.empty()) on.wind = position(scene_.wind, time + seconds / 2);
    return on;
}

bool Play::step(double seconds, const Acting& on) {
    std::vector<Stats> stats;
    for (std::size_t m = 0; m < solvers_.size(); ++m) {
        stats.push_back(solvers_[m]->step(seconds, {.presses = on.presses,
                                                    .drags = on.bodies[m].drags,
                                                    .moves = on.bodies[m].moves,
                                                    .colliders = on.colliders,
                                                    .wind = on.wind}));
        if (!stats[m].diverged) continue;
        report_.notes.push_back(
            fmt::format("body {} diverged with steps of {:.4g} s", report_.bodies[m].name, stats[m].step));
        for (std::size_t other = 0; other < m; ++other) solvers_[other]->undo();
        return false;
    }
    stats_ = std::move(stats);
    return true;
}

void Play::map() const {
    Timed timed(report_.seconds.map);
    for (std::size_t m = 0; m < solvers_.size(); ++m)
        deform(made_.models[m].embedding, solvers_[m]->nodes(), skins_[m].positions, skins_[m].normals,
               nullptr, &team_);
    mapped_ = true;
}

void Play::record(const Acting& on, double time, double seconds) {
    std::vector<dvec3> impulses(handles_.size(), dvec3(0));
    tools_.assign(handles_.size(), std::nullopt);
    pushes_.presses.assign(on.presses.size() - on.tool_of_press.size(), dvec3(0));
    pushes_.pulls.assign(on.pulls, dvec3(0));
    for (std::size_t t : on.tool_of_press) tools_[t] = {std::get<Tip>(handles_[t]).centre(time), {}};
    for (std::size_t m = 0; m < solvers_.size(); ++m) {
        const Stats& stats = stats_[m];
        const std::size_t tips = on.tool_of_press.size(), grips = on.bodies[m].tool_of_drag.size();
        for (std::size_t p = 0; p < tips; ++p) impulses[on.tool_of_press[p]] += stats.reactions[p];
        for (std::size_t p = tips; p < on.presses.size(); ++p)
            pushes_.presses[p - tips] += stats.reactions[p] / seconds;
        for (std::size_t d = grips; d < on.bodies[m].drags.size(); ++d)
            pushes_.pulls[on.bodies[m].pull_of_drag[d - grips]] = stats.pulls[d] / seconds;
        for (std::size_t d = 0; d < grips; ++d) {
            const std::size_t t = on.bodies[m].tool_of_drag[d];
            impulses[t] += stats.pulls[d];
            const std::size_t node = std::size_t(on.bodies[m].drags[d].node);
            tools_[t] = {std::get<Grip>(handles_[t]).centre(time), nodes(m).positions[node]};
        }
        Report::Body& body = report_.bodies[m];
        body.steps += stats.steps;
        if (body.step == 0 || stats.step < body.step) body.step = stats.step;
        body.largest_speed = std::max(body.largest_speed, stats.largest_speed);
    }
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        const auto* tip = std::get_if<Tip>(&handles_[t]);
        double force = glm::length(impulses[t]) / seconds;
        double depth = tip && tools_[t] ? tip->indentation(tools_[t]->centre, skins()) : 0;
        if (const auto* one = std::get_if<Probe>(&handles_[t]); one && one->is_there(time - seconds)) {
            tools_[t] = {one->centre(), {}};
            force = one->force();
            depth = one->depth();
        }
        Report::Tool& tool = report_.tools[t];
        tool.largest_force = std::max(tool.largest_force, force);
        tool.deepest_indentation = std::max(tool.deepest_indentation, depth);
        tool.time.push_back(time);
        tool.force.push_back(force);
        tool.indentation.push_back(depth);
    }
    // From a GPU nodes are not fetched for this alone.
    for (std::size_t m = 0; mapped_ && m < solvers_.size(); ++m) {
        std::size_t& worst = report_.bodies[m].inverted_cells;
        worst = std::max(worst, inverted_cells(made_.models[m].body, nodes(m).positions));
    }
}

}  // namespace palpate
