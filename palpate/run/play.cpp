#include "palpate/run/play.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/mesh/repair.h"
#include "palpate/run/run.h"

#include <fmt/format.h>

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

// s: bodies that hands press go on for so long before the hands feel them again; and where contacts are
// followed.
double slice_for(const Scene& scene, bool follows_contacts) {
    return follows_contacts || has_tool(scene, ToolKind::touch) ? slice_seconds : frame_seconds;
}

// A surface in a cage may be open; every other one except cloth encloses a volume.
bool is_sheet(const BodyRecipe& recipe, const Mesh& surface) {
    return recipe.is_cloth() || (recipe.cage && soundness(surface).open_edges > 0);
}

// The places of the nodes of a prescribed motion at a time.
std::vector<vec3> places(const MovedNodes& moved, const Path& path, const Body& body, double time) {
    const Pose at = pose(path, time);
    std::vector<vec3> to;
    for (int node : moved.nodes) {
        const vec3 rest = body.positions[std::size_t(node)];
        to.push_back(moved.about + vec3(at.of(dvec3(rest - moved.about))));
    }
    return to;
}

}  // namespace

// The scene's tools come first, then the interaction.
struct Play::Acting {
    std::vector<Press> presses;
    std::vector<std::size_t> tool_of_press;
    std::vector<BodyPush> pushes;
    std::vector<std::size_t> tool_of_push;
    std::vector<std::vector<vec3>> places;  // the targets of the moves
    std::vector<BodyMove> moves;
    std::vector<Motion> colliders;
    vec3 wind = vec3(0);
    decltype(Acts::press_in_slice) press_in_slice;
    decltype(Acts::after_slice) after_slice;
};

Motion motion_between(const Pose& from, const Pose& to, vec3 pivot, double seconds) {
    Motion motion;
    motion.position = pivot + vec3(from.place);
    motion.rotation = mat3(glm::mat3_cast(from.turn));
    motion.velocity = vec3((to.place - from.place) / seconds);
    dquat way = to.turn * glm::conjugate(from.turn);
    if (way.w < 0) way = -way;
    const dvec3 axis(way.x, way.y, way.z);
    if (const double sine = glm::length(axis); sine > 0)
        motion.spin = vec3(axis / sine * (2 * std::atan2(sine, way.w) / seconds));
    return motion;
}

Play::Play(const Scene& scene, const Models& made, Report& report, const gl::Context* context,
           std::span<const double> frequencies, bool follows_contacts)
    : scene_(scene),
      made_(made),
      report_(report),
      world_(made.simulation, context, nullptr, slice_for(scene, follows_contacts)),
      skins_(made.models.size() + made.static_surfaces.size()),
      tools_(scene.tools.size()),
      follows_contacts_(follows_contacts) {
    for (const Model& model : made.models) {
        const std::size_t m = world_.count();
        world_.add(model.body, m < frequencies.size() ? frequencies[m] : 0);
        report.bodies.push_back(describe(model));
    }
    for (const StaticSurface& still : made.static_surfaces) {
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
        report.tools.emplace_back().name = tool.name;
    }
    const std::size_t models = made.models.size();
    for (std::size_t m = 0; m < models; ++m) {
        const Mesh& surface = made.models[m].surface;
        skins_[m].triangles = &surface.triangles;
        skins_[m].is_sheet = is_sheet(scene.bodies[m], surface);
    }
    for (std::size_t s = 0; s < made.static_surfaces.size(); ++s) {
        const Mesh& surface = made.static_surfaces[s].surface;
        skins_[models + s] = {surface.positions, surface.normals, &surface.triangles,
                              is_sheet(scene.surfaces[s], surface)};
    }
    if (!on_gpu(made.simulation.backend)) map();
}

const std::vector<Skin>& Play::skins() const {
    if (mapped_ != Mapped::all) map();
    return skins_;
}

const std::vector<Skin>& Play::touchable() const {
    if (mapped_ != Mapped::no) return skins_;
    Timed timed(report_.seconds.map);
    for (std::size_t m = 0; m < world_.count(); ++m)
        deform(made_.models[m].embedding, nodes(m), skins_[m].positions, &world_.team());
    mapped_ = Mapped::positions;
    return skins_;
}

int Play::steps_per_frame() const { return steps_within(frame_seconds, world_.shortest_step(frame_seconds)); }

std::vector<State> Play::states() const {
    std::vector<State> states;
    for (std::size_t m = 0; m < world_.count(); ++m) states.push_back(world_.solver(m).state());
    return states;
}

std::vector<State> Play::save() const { return world_.save(); }

void Play::restore(const std::vector<State>& states) {
    world_.restore(states);
    mapped_ = Mapped::no;
    for (auto& handle : handles_)
        if (auto* one = std::get_if<Probe>(&handle)) one->expect_jump();
}

void Play::take_tools(const Play& from) {
    if (from.handles_.size() != handles_.size())
        throw Error("a different number of tools", "the scene whose tools are taken over",
                    "give both scenes the same tools");
    for (std::size_t t = 0; t < handles_.size(); ++t)
        if (const auto* tip = std::get_if<Tip>(&from.handles_[t])) {
            Tip same = *tip;
            same.lies_over(skins());
            handles_[t] = std::move(same);
        } else if (const auto* grip = std::get_if<Grip>(&from.handles_[t])) {
            handles_[t] = *grip;
        }
    tools_ = from.tools_;
    interaction_forces_ = from.interaction_forces_;
    time_ = from.time_;
}

void Play::take_probes(Play& from) {
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        if (!std::holds_alternative<Probe>(from.handles_[t])) continue;
        handles_[t] = std::move(from.handles_[t]);
        auto& probe = std::get<Probe>(handles_[t]);
        probe.set(feels_of(scene_));
        probe.expect_jump();
    }
}

std::size_t Play::memory() const { return world_.memory(); }

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

// The probes feel the surfaces as they are at `time`, and extrapolate.
void Play::probe(double time, double seconds) {
    if (!has_tool(scene_, ToolKind::dent)) return;
    skins();  // which have their own time
    Timed timed(report_.seconds.simulate);
    for (auto& handle : handles_)
        if (auto* one = std::get_if<Probe>(&handle); one && !one->presses() && one->is_there(time))
            one->advance(time, seconds, skins_, !made_.models.empty());
}

// What hands do to the bodies that they feel. One that is not there presses nothing, so that reactions keep
// their places.
std::vector<Press> Play::press(double time, double seconds, std::span<const dvec3> reactions) {
    std::vector<Probe*> probes;
    for (auto& handle : handles_)
        if (auto* one = std::get_if<Probe>(&handle); one && one->presses()) probes.push_back(one);
    auto is_there = [time](const Probe* one) { return one->is_there(time); };
    std::vector<Press> all;
    for (Probe* one : probes) {
        std::optional<dvec3> reaction;
        if (all.size() < reactions.size()) reaction = reactions[all.size()];
        all.push_back(is_there(one) ? one->press(time, seconds, reaction, *this, made_)
                                    : Press{.stiffness = 0});
    }
    return all;
}

bool Play::advance(double time, double seconds, const Interaction& hands) {
    probe(time, seconds);
    Acting on = acting(time, seconds, hands);
    on.after_slice = [&](const WorldSlice& slice) {
        mapped_ = Mapped::no;
        measure(on, time, seconds, slice);
    };
    contacts_.clear();
    const double mapping = report_.seconds.map;
    bool whole = false;
    {
        Timed timed(report_.seconds.simulate);
        whole = step(seconds, on);
    }
    report_.seconds.simulate -= report_.seconds.map - mapping;  // which has its own time
    if (!whole) {
        mapped_ = Mapped::no;  // hands may have felt slices that were undone
        return false;
    }
    time_ = time + seconds;
    record(on, time + seconds, seconds);
    return true;
}

Play::Acting Play::acting(double time, double seconds, const Interaction& hands) {
    Acting on;
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        if (auto* tip = std::get_if<Tip>(&handles_[t])) {
            if (!tip->is_there(time)) continue;
            on.presses.push_back(tip->press(time, seconds, skins()));
            on.tool_of_press.push_back(t);
        } else if (auto* grip = std::get_if<Grip>(&handles_[t])) {
            const auto drag = grip->drag(time, seconds, made_.models, world_);
            if (!drag) continue;
            on.pushes.push_back({grip->body(), *drag});
            on.tool_of_push.push_back(t);
        }
    }
    on.presses.insert(on.presses.end(), hands.presses.begin(), hands.presses.end());
    on.pushes.insert(on.pushes.end(), hands.pulls.begin(), hands.pulls.end());
    for (std::size_t i = 0; i < made_.moves.size(); ++i) {
        const MovedNodes& moved = made_.moves[i];
        on.places.push_back(
            places(moved, scene_.moves[i].path, made_.models[moved.body].body, time + seconds));
    }
    for (std::size_t i = 0; i < made_.moves.size(); ++i)
        on.moves.push_back({made_.moves[i].body, {made_.moves[i].nodes, on.places[i]}});
    on.colliders = colliders(time, seconds);
    if (!scene_.wind.empty()) on.wind = position(scene_.wind, time + seconds / 2);
    if (has_tool(scene_, ToolKind::touch))
        on.press_in_slice = [=, this](double at, double slice, std::span<const dvec3> reactions) {
            return press(time + at, slice, reactions);
        };
    return on;
}

bool Play::step(double seconds, const Acting& on) {
    WorldStats stats = world_.step(seconds, {.presses = on.presses,
                                             .pushes = on.pushes,
                                             .moves = on.moves,
                                             .colliders = on.colliders,
                                             .wind = on.wind,
                                             .press_in_slice = on.press_in_slice,
                                             .after_slice = on.after_slice});
    if (stats.diverged) {
        contacts_.clear();
        const std::size_t m = *stats.diverged;
        report_.notes.push_back(fmt::format("body {} diverged with steps of {:.4g} s", report_.bodies[m].name,
                                            stats.bodies[m].step));
        return false;
    }
    stats_ = std::move(stats);
    return true;
}

void Play::map() const {
    Timed timed(report_.seconds.map);
    for (std::size_t m = 0; m < world_.count(); ++m)
        deform(made_.models[m].embedding, nodes(m), skins_[m].positions, skins_[m].normals, nullptr,
               &world_.team());
    mapped_ = Mapped::all;
}

// Tips come first, then the interaction, then hands that feel what they press, as press() has returned them.
// From a GPU nodes are not fetched for the report alone.
void Play::measure(const Acting& on, double time, double seconds, const WorldSlice& slice) {
    const bool is_last = slice.at + slice.seconds > seconds - 1e-9;
    const bool is_shown = std::ranges::any_of(
        scene_.bodies, [](const BodyRecipe& recipe) { return recipe.shade == Shade::pressure; });
    if (!follows_contacts_ && (!is_last || (on_gpu(made_.simulation.backend) && !is_shown))) return;
    std::vector<std::optional<std::size_t>> tools(on.presses.size());
    std::ranges::copy(on.tool_of_press, tools.begin());
    for (std::size_t t = 0; t < handles_.size(); ++t)
        if (auto* one = std::get_if<Probe>(&handles_[t]); one && one->presses()) {
            tools.emplace_back();
            if (one->is_there(time + slice.at)) tools.back() = t;
        }
    for (std::size_t p = 0; p < tools.size(); ++p)
        for (std::size_t m = 0; tools[p] && m < world_.count(); ++m) {
            const Press tip = after(slice.presses[p], float(slice.seconds));
            contacts_.push_back({*tools[p],
                                 m,
                                 time + slice.at + slice.seconds,
                                 dvec3(0) - slice.bodies[m].reactions[p] / slice.seconds,
                                 tip,
                                 contact_force(world_.solver(m).body(), nodes(m).positions, tip),
                                 {}});
            if (follows_contacts_) contacts_.back().taxels = on_pad(contacts_.back());
        }
}

// Of the surface as it has been mapped.
std::vector<double> Play::on_pad(const ToolContact& contact) const {
    std::optional<Pad> pad = scene_.tools[contact.tool].pad;
    if (!pad) return {};
    pad->centre += contact.press.centre;
    const Skin& skin = touchable()[contact.body];
    return taxels(*pad, skin.positions,
                  pressed_vertices(skin.positions, *skin.triangles, contact.press, contact.push()));
}

std::vector<float> Play::pressures(std::size_t body) const {
    const Skin& skin = skins()[body];
    std::vector<float> sum(skin.positions.size(), 0);
    for (const ToolContact& contact : contacts_) {
        if (contact.body != body || contact.time < time_ - 1e-9) continue;
        for (const PressedVertex& one :
             pressed_vertices(skin.positions, *skin.triangles, contact.press, contact.push()))
            sum[one.vertex] += float(one.pressure);
    }
    return sum;
}

void Play::record(const Acting& on, double time, double seconds) {
    std::vector<dvec3> impulses(handles_.size(), dvec3(0));
    tools_.assign(handles_.size(), std::nullopt);
    // The solver sums impulses; the interaction reports mean forces.
    const std::size_t tips = on.tool_of_press.size(), grips = on.tool_of_push.size();
    interaction_forces_ = {};
    for (std::size_t p = 0; p < on.presses.size(); ++p)
        if (p < tips)
            impulses[on.tool_of_press[p]] += stats_.reactions[p];
        else
            interaction_forces_.presses.push_back(stats_.reactions[p] / seconds);
    for (std::size_t d = 0; d < on.pushes.size(); ++d)
        if (d < grips)
            impulses[on.tool_of_push[d]] += stats_.pushes[d];
        else
            interaction_forces_.pulls.push_back(stats_.pushes[d] / seconds);
    for (std::size_t t : on.tool_of_press) tools_[t] = {std::get<Tip>(handles_[t]).centre(time), {}};
    for (std::size_t d = 0; d < grips; ++d) {
        const auto& [body, push] = on.pushes[d];
        const std::size_t t = on.tool_of_push[d];
        tools_[t] = {std::get<Grip>(handles_[t]).centre(time), nodes(body).positions[std::size_t(push.node)]};
    }
    for (std::size_t m = 0; m < world_.count(); ++m) {
        const Stats& stats = stats_.bodies[m];
        Report::Body& body = report_.bodies[m];
        body.steps += stats.steps;
        if (body.step == 0 || stats.step < body.step) body.step = stats.step;
        body.largest_speed = std::max(body.largest_speed, stats.largest_speed);
    }
    for (std::size_t t = 0; t < handles_.size(); ++t) {
        const auto* tip = std::get_if<Tip>(&handles_[t]);
        double force = glm::length(impulses[t]) / seconds;
        double depth = tip && tools_[t] ? tip->indentation(tools_[t]->centre, skins()) : 0;
        if (auto* one = std::get_if<Probe>(&handles_[t]); one && one->is_there(time - seconds)) {
            tools_[t] = {one->centre(), {}};
            force = one->take_force();
            depth = one->depth(skins());
        }
        Report::Tool& tool = report_.tools[t];
        tool.largest_force = std::max(tool.largest_force, force);
        tool.deepest_indentation = std::max(tool.deepest_indentation, depth);
        tool.time.push_back(time);
        tool.force.push_back(force);
        tool.indentation.push_back(depth);
    }
    for (const ToolContact& contact : contacts_) {
        Report::Tool& tool = report_.tools[contact.tool];
        tool.largest_normal_force = std::max(tool.largest_normal_force, contact.normal());
        tool.deepest_penetration = std::max(tool.deepest_penetration, contact.end.penetration);
        tool.largest_area = std::max(tool.largest_area, contact.end.area());
        tool.largest_pressure = std::max(tool.largest_pressure, contact.end.pressure());
    }
    count_inverted_cells(time);
}

// Once a frame. From a GPU nodes are not fetched for this alone.
void Play::count_inverted_cells(double time) {
    if (time < counted_ + 0.99 * frame_seconds || (on_gpu(made_.simulation.backend) && mapped_ == Mapped::no))
        return;
    counted_ = time;
    for (std::size_t m = 0; m < world_.count(); ++m) {
        Report::Body& body = report_.bodies[m];
        body.inverted_now = inverted_cells(made_.models[m].body, nodes(m).positions);
        body.inverted_cells = std::max(body.inverted_cells, body.inverted_now);
    }
}

}  // namespace palpate
