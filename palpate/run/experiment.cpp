#include "palpate/run/experiment.h"

#include "palpate/base/error.h"
#include "palpate/body/select.h"
#include "palpate/run/run.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace palpate {
namespace {

constexpr long slices_between_good = 30 * slices_per_frame;
constexpr std::size_t most_good = 5;          // so the oldest is about two seconds old
constexpr std::size_t most_inputs = 500'000;  // of a recording: hours, or minutes of a live hand
constexpr double longest_curve = 60;          // s, of a report

std::string key_of(const Change& change) { return change.substr(0, change.find('=')); }

// Keys that do not affect surfaces, embeddings or anything else that is drawn.
bool leaves_shapes(const Change& change) {
    const std::string key = key_of(change), last = key.substr(key.rfind('.') + 1);
    if (key.starts_with("simulation.") || key == "wind" || key.starts_with("wind.")) return true;
    if (key.find(".touch.") != std::string::npos) return true;
    if (key.starts_with("collider."))  // planes and balls are drawn from their present values
        return last == "friction" || last == "margin" || key.find(".plane.") != std::string::npos ||
               key.find(".sphere.") != std::string::npos;
    for (const char* one :
         {"youngs_modulus", "poisson", "model", "stiffness", "springs", "structural", "shear", "flexion",
          "bending", "density", "mass", "damping", "link_damping", "pin", "tissue"})
        if (last == one) return key.starts_with("body.");
    return false;
}

bool same_shapes(const std::vector<Change>& a, const std::vector<Change>& b) {
    auto all_of_other = [](const std::vector<Change>& some, const std::vector<Change>& others) {
        return std::ranges::all_of(some, [&](const Change& change) {
            return leaves_shapes(change) || std::ranges::find(others, change) != others.end();
        });
    };
    return all_of_other(a, b) && all_of_other(b, a);
}

bool same_nodes(const Body& a, const Body& b) { return a.name == b.name && a.positions == b.positions; }

// Merges changes: new ones replace those of the same key.
std::vector<Change> with(std::vector<Change> changes, const std::vector<Change>& more) {
    for (const Change& one : more) {
        std::erase_if(changes, [&](const Change& old) { return key_of(old) == key_of(one); });
        changes.push_back(one);
    }
    return changes;
}

float stiffest(const Body& body) {
    float most = 0;
    for (const Term& term : body.terms)
        if (const auto* grid = std::get_if<GridSprings>(&term))
            for (const Link& link : grid->links) most = std::max(most, link.stiffness);
        else if (const auto* listed = std::get_if<ListedSprings>(&term))
            for (const Spring& spring : listed->springs) most = std::max(most, spring.stiffness);
        else if (const auto* cells = std::get_if<TissueCells>(&term))  // as springs of that modulus would be
            most = std::max(most, 0.4f * cells->youngs_modulus * body.spacing);
    return most;
}

}  // namespace

Prepared prepare(SceneText source, std::vector<Change> changes, const Progress& progress) {
    Prepared prepared{std::move(source), std::move(changes), {}, {}};
    prepared.source.folder = std::filesystem::absolute(prepared.source.folder / ".");  // recordings may be
                                                                                       // moved
    prepared.scene = parse_scene(prepared.source, prepared.changes);
    check_devices(prepared.scene);
    prepared.models = build(prepared.scene, progress);
    return prepared;
}

Prepared prepare(Models models) {
    Scene scene;
    scene.simulation = models.simulation;
    scene.simulation.colliders.clear();  // there they are recipes
    auto add = [](std::vector<BodyRecipe>& recipes, const std::string& name, const Mesh& surface) {
        BodyRecipe& recipe = recipes.emplace_back();
        recipe.name = name;
        recipe.sheet = soundness(surface).open_edges > 0;
    };
    for (const Model& model : models.models) add(scene.bodies, model.body.name, model.surface);
    for (const StaticSurface& still : models.static_surfaces) add(scene.surfaces, still.name, still.surface);
    for (const Collider& collider : models.simulation.colliders)
        scene.colliders.emplace_back().collider = collider;
    models.pivots.resize(scene.colliders.size(), vec3(0));
    for (std::size_t i = 0; i < models.moves.size(); ++i) scene.moves.emplace_back().path = {Waypoint{}};
    scene.name = scene.bodies.empty() ? "models" : scene.bodies.front().name;
    return {{.text = {}, .name = scene.name, .folder = "."}, {}, std::move(scene), std::move(models)};
}

Prepared prepare(Body body, Mesh surface) {
    if (body.name.empty()) body.name = "body";
    if (surface.normals.empty()) compute_normals(surface);
    Embedding embedding = embed(surface, body);
    Models models;
    models.models.push_back({std::move(body), std::move(surface), std::move(embedding), {}, {}});
    return prepare(std::move(models));
}

Strength strength_for(const Body& body) {
    float lightest = 0, widest = 0;  // 1/kg, of the heaviest node; m²/kg
    for (std::size_t i = 0; i < body.count(); ++i) {
        const float inverse = body.inverse_mass[i];
        if (inverse > 0 && (lightest == 0 || inverse < lightest)) lightest = inverse;
        widest = std::max(widest, body.area[i] * inverse);
    }
    const float most =
        1.5f * stiffest(body) * lightest;  // 1/s², by how much a hand may raise the square of the frequency
    return {most, widest > 0 ? most / widest : 0};
}

// ---- making it ----

namespace {

// Frequencies of unchanged bodies are taken over, because they take longest to compute.
std::vector<double> known_frequencies(const Models& models, const Models& before, const Play& play) {
    std::vector<double> known(models.models.size(), 0);
    for (std::size_t m = 0; m < known.size(); ++m)
        for (std::size_t old = 0; old < before.models.size(); ++old) {
            const Body &a = models.models[m].body, &b = before.models[old].body;
            if (same_nodes(a, b) && a.inverse_mass == b.inverse_mass && a.terms == b.terms && a.at == b.at)
                known[m] = play.frequency(old);
        }
    return known;
}

}  // namespace

Experiment::Experiment(Prepared prepared, const gl::Context* context)
    : Experiment(std::move(prepared), context, nullptr) {}

// `other`: may know the frequencies of the same bodies.
Experiment::Experiment(Prepared prepared, const gl::Context* context, const Experiment* other)
    : context_(context),
      history_{{prepared.changes, {}}},
      done_{std::move(prepared.source), prepared.changes, {}, 0, {}} {
    records_ = has_text() && !other;
    if (!has_text())
        for (const Model& model : prepared.models.models) free_.push_back(model.body.inverse_mass);
    take(put_together(std::move(prepared.scene), std::move(prepared.models), other));
}

void Experiment::require_text() const {
    if (!has_text())
        throw Error("a scene without a text, which cannot be changed by key, compared, saved or recorded",
                    source().name, "pin its nodes; or describe it by a scene");
}

Experiment::Made Experiment::make(const Setting& setting) const {
    if (has_text()) {
        Scene scene = parse_scene(source(), setting.changes);
        Models models = rebuild(scene, this->scene(), this->models());
        return put_together(std::move(scene), std::move(models), this);
    }
    Models models = this->models();
    for (std::size_t m = 0; m < models.models.size(); ++m) {
        models.models[m].body.inverse_mass = free_[m];
        if (m < setting.pinned.size()) palpate::pin(models.models[m].body, setting.pinned[m]);
    }
    return put_together(scene(), std::move(models), this);
}

Experiment::Made Experiment::put_together(Scene scene, Models models, const Experiment* other) const {
    scene.simulation.force = models.simulation.force = true;
    Made made{.scene = std::make_unique<Scene>(std::move(scene)),
              .models = std::make_unique<Models>(std::move(models)),
              .report = std::make_unique<Report>(),
              .play = nullptr};
    std::vector<double> known;
    if (other) known = known_frequencies(*made.models, other->models(), other->play());
    made.play = std::make_unique<Play>(*made.scene, *made.models, *made.report, context_, known);
    return made;
}

void Experiment::take(Made made) {
    std::swap(made_, made);
    trouble_.clear();
}

// Bodies with the same nodes keep their state. A node that is pinned now has zero velocity.
void Experiment::carry_over(Made& made) {
    const std::vector<State> before = play().save();
    std::vector<State> states = made.play->save();
    for (std::size_t m = 0; m < states.size(); ++m) {
        const Body& body = made.models->models[m].body;
        for (std::size_t old = 0; old < before.size(); ++old)
            if (same_nodes(models().models[old].body, body)) states[m] = before[old];
        for (std::size_t i = 0; i < body.count(); ++i)
            if (!(body.inverse_mass[i] > 0)) states[m].velocities[i] = dvec3(0);
    }
    made.play->restore(states);
    if (!fits(made)) return;
    made.play->take_tools(play());
    made.play->take_probes(*made_.play);
}

// Whether its tools can continue with what they touch and hold.
bool Experiment::fits(const Made& made) const {
    const auto &now = made.models->models, &before = models().models;
    if (made.scene->tools != scene().tools || now.size() != before.size()) return false;
    for (std::size_t m = 0; m < now.size(); ++m)
        if (!same_nodes(now[m].body, before[m].body) ||
            now[m].surface.triangles != before[m].surface.triangles)
            return false;
    return std::ranges::equal(made.models->static_surfaces, models().static_surfaces,
                              [](const StaticSurface& a, const StaticSurface& b) {
                                  return a.surface.triangles == b.surface.triangles;
                              });
}

void Experiment::set(const Setting& setting) {
    Made made = make(setting);
    carry_over(made);
    if (!same_shapes(setting.changes, changes())) shapes_ = std::make_shared<char>();
    take(std::move(made));
    record({done_.advances, SetChanges{setting.changes}});
}

std::unique_ptr<Experiment> Experiment::beside(const std::vector<Change>& more) const {
    require_text();
    Prepared prepared{source(), with(changes(), more), {}, {}};
    prepared.scene = parse_scene(source(), prepared.changes);
    prepared.models = rebuild(prepared.scene, scene(), models());
    std::unique_ptr<Experiment> other(new Experiment(std::move(prepared), context_, this));
    other->made_.play->restore(play().save());
    other->made_.play->take_tools(play());
    other->slice_ = slice_;
    return other;
}

// ---- changes ----

void Experiment::change(const std::vector<Change>& changes, bool again) {
    require_text();
    const Setting all{with(this->changes(), changes), {}};
    set(all);
    if (again && at_ > 0) --at_;
    add_to_history(all);
}

// Changes that were undone are dropped.
void Experiment::add_to_history(Setting setting) {
    history_.resize(at_ + 1);
    history_.push_back(std::move(setting));
    ++at_;
}

void Experiment::undo() {
    if (!can_undo()) return;
    set(history_[at_ - 1]);
    --at_;
}

void Experiment::redo() {
    if (!can_redo()) return;
    set(history_[at_ + 1]);
    ++at_;
}

void Experiment::restart() {
    take(make(history_[at_]));
    slice_ = 0;
    good_.clear();
    done_ = {source(), changes(), {}, 0, {}};
    replayed_ = 0;
}

void Experiment::return_to_good() {
    if (good_.empty()) return;
    const Good good = good_.front();
    Made made = make(good.setting);
    made.play->restore(good.states);
    if (fits(made)) made.play->take_tools(play());
    if (!same_shapes(good.setting.changes, changes())) shapes_ = std::make_shared<char>();
    take(std::move(made));
    record({done_.advances, ReturnToGood{}});
    slice_ = good.slice;
    if (good.setting != history_[at_]) add_to_history(good.setting);
    good_ = {good};
}

void Experiment::pin(std::size_t body, const std::vector<int>& nodes, bool fast) {
    const std::vector<float>& inverse_mass = models().models[body].body.inverse_mass;
    std::vector<char> held(inverse_mass.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = !(inverse_mass[i] > 0);
    for (const MovedNodes& moved : models().moves)
        if (moved.body == body)
            for (int node : moved.nodes) held[std::size_t(node)] = false;  // held by the motion, not by a pin
    for (int node : nodes) {
        if (!has_text() && !fast && !(free_[body][std::size_t(node)] > 0))
            throw Error(fmt::format("node {} was made with infinite mass, so it cannot be released", node),
                        "body " + models().models[body].body.name,
                        "pin it here rather than where it is made");
        held[std::size_t(node)] = fast;
    }
    std::vector<int> list;
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i]) list.push_back(int(i));
    if (has_text())
        return change({fmt::format("body.{}.pin={{nodes=[{}]}}", body + 1, fmt::join(list, ","))});
    Setting more = history_[at_];
    more.pinned.resize(models().models.size());
    more.pinned[body] = std::move(list);
    set(more);
    add_to_history(std::move(more));
}

bool Experiment::is_pinned(std::size_t body, int node) const {
    return !(models().models[body].body.inverse_mass[std::size_t(node)] > 0);
}

double Experiment::time() const { return double(slice_) / slices_per_frame * frame_seconds; }

double Experiment::stable_step(std::size_t body) const {
    const Body& of = models().models[body].body;
    return longest_step(models().simulation.integrator, play().frequency(body), of.damping, of.link_damping);
}

// ---- going on ----

bool Experiment::advance(const Interaction& hands, int slices) {
    if (!trouble_.empty()) return false;
    if (good_.empty() || slice_ >= good_.back().slice + slices_between_good) remember();
    if (!hands.empty() || slices != slices_per_frame) record({done_.advances, hands, slices});
    ++done_.advances;
    if (!made_.play->advance(time(), slices * slice_seconds, hands)) {
        trouble_ = report().notes.empty() ? "the motion blew up" : report().notes.back();
        return false;
    }
    slice_ += slices;
    for (Report::Tool& tool : made_.report->tools)
        if (!tool.time.empty() && tool.time.back() > tool.time.front() + longest_curve)
            tool.time.clear(), tool.force.clear(), tool.indentation.clear();
    return true;
}

void Experiment::remember() {
    good_.push_back({slice_, history_[at_], play().save()});
    if (good_.size() > most_good) good_.pop_front();
}

Energy Experiment::energy() const {
    Energy sum;
    const std::vector<State> states = play().states();
    for (std::size_t m = 0; m < states.size(); ++m) {
        const Energy one = palpate::energy(models().models[m].body, states[m]);
        sum.kinetic += one.kinetic;
        sum.elastic += one.elastic;
    }
    return sum;
}

// ---- recordings ----

void Experiment::record(Input input) {
    if (records_ && done_.inputs.size() <= most_inputs) done_.inputs.push_back(std::move(input));
}

bool Experiment::recording_is_full() const { return done_.inputs.size() > most_inputs; }

Recording Experiment::recording() const {
    require_text();
    if (recording_is_full())
        throw Error("more inputs than a recording holds", "the experiment", "restart it to begin a new one");
    Recording all = done_;
    all.fingerprint = fingerprint();
    return all;
}

bool Experiment::replay(const Recording& recording) {
    require_text();
    for (int slices = 0; slices < slices_per_frame;) {
        const int more = replay_one(recording);
        if (more == 0) return false;
        slices += more;
    }
    return true;
}

// By how many slices it advances; 0 at its end.
int Experiment::replay_one(const Recording& recording) {
    Interaction hands;
    int slices = slices_per_frame;
    for (; replayed_ < recording.inputs.size() && recording.inputs[replayed_].at <= done_.advances;
         ++replayed_) {
        const Input& input = recording.inputs[replayed_];
        if (const auto* some = std::get_if<Interaction>(&input.what)) {
            hands = *some;
            slices = input.slices;
        } else if (const auto* set_to = std::get_if<SetChanges>(&input.what)) {
            set({set_to->changes, {}});
            add_to_history({set_to->changes, {}});
        } else {
            return_to_good();
        }
    }
    if (done_.advances >= recording.advances || !trouble_.empty()) return 0;
    if (!takes(hands))
        throw Error(fmt::format("input {} is one that the bodies cannot take", replayed_), "the recording",
                    "replay it with the files that it was made with");
    advance(hands, slices);
    return slices;
}

bool Experiment::takes(const Interaction& hands) const {
    // Times the usual stiffness: with pulls the step is about a hundredth then; a tip may be much smaller.
    constexpr float most = 1e4f, most_of_tip = 1e8f;
    const auto& models = this->models().models;
    float pressure = 0;
    for (const Model& model : models) pressure = std::max(pressure, strength_for(model.body).pressure);
    for (const Press& press : hands.presses)
        if (!(press.radius > 0 && press.stiffness >= 0 &&
              pressure_per_metre(press) <= most_of_tip * pressure))
            return false;
    std::vector<float> strengths;
    for (const Model& model : models) strengths.push_back(most * strength_for(model.body).pull);
    for (const BodyPush& pull : hands.pulls) {
        if (pull.body >= models.size()) return false;
        const Body& body = models[pull.body].body;
        if (pull.push.node < 0 || std::size_t(pull.push.node) >= body.count()) return false;
        const float added = pull.push.stiffness * body.inverse_mass[std::size_t(pull.push.node)];
        if (!(added >= 0 && added <= strengths[pull.body])) return false;
    }
    return true;
}

std::string Experiment::fingerprint() const {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const State& state : play().save())
        for (const auto* list : {&state.positions, &state.velocities})
            for (const dvec3& v : *list)
                for (double number : {v.x, v.y, v.z}) {
                    std::uint64_t bits;
                    std::memcpy(&bits, &number, sizeof bits);
                    hash = (hash ^ bits) * 1099511628211u;
                }
    return fmt::format("{:016x}", hash);
}

}  // namespace palpate
