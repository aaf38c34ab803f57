#include "palpate/solver/solver.h"

#include "palpate/base/error.h"
#include "palpate/solver/check.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/pushes.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

Solver::MakeMachine machine_for(Backend backend, [[maybe_unused]] const gl::Context* context, Team* team) {
    switch (backend) {
        case Backend::reference:
            return make_reference<float>;
        case Backend::cpu:
            return [=](const Body& body, const Simulation& simulation) {
                return make_cpu(body, simulation, team);
            };
        case Backend::feedback:
        case Backend::fragment:
        case Backend::compute:
#if defined(PALPATE_OPENGL)
            return [=](const Body& body, const Simulation& simulation) {
                return make_gpu(body, simulation, context);
            };
#else
            throw missing_part("opengl", fmt::format("the backend {}", name_of(backend)),
                               "use the backend cpu");
#endif
    }
    throw Error("an unknown backend", "the simulation", "choose one of " + all_names<Backend>());
}

// What acts on a body during a call as it is seen from the origin, with memory of its own.
struct LocalActs {
    Influences influences;
    std::vector<Press> presses;
    std::vector<NodePush> pushes;
    std::vector<Guide> guides;

    LocalActs(const Influences& world, std::span<const Guide> leads, const Origin& origin, double seconds)
        : influences(world),
          presses(world.presses.begin(), world.presses.end()),
          pushes(world.pushes.begin(), world.pushes.end()),
          guides(leads.begin(), leads.end()) {
        auto see = [&](vec3& place, vec3& velocity) {
            place = vec3(dvec3(place) - origin.place);
            velocity = vec3(dvec3(velocity) - origin.velocity);
        };
        for (Press& press : presses) see(press.centre, press.velocity);
        for (NodePush& push : pushes) see(push.to, push.velocity);
        for (Guide& guide : guides) {
            guide.velocity -= origin.velocity;
            guide.to -= origin.after(seconds).place;
            guide.is_led |= origin.velocity != dvec3(0);
        }
        influences.presses = presses;
        influences.pushes = pushes;
        influences.wind = vec3(dvec3(world.wind) - origin.velocity);
    }
    LocalActs(const LocalActs&) = delete;
};

}  // namespace

int steps_within(double seconds, double longest) {
    const double steps = std::ceil(seconds / longest - 1e-6);  // rounding alone is not worth a step
    if (!(steps <= 1e9))
        throw Error(fmt::format("{:.3g} steps of {:.3g} s for {:.3g} s", steps, longest, seconds),
                    "a call of step()", "step by less at once");
    return int(std::max(steps, 1.0));
}

Solver::Solver(const Body& body, const Simulation& simulation, double frequency, const MakeMachine& make)
    : body_((palpate::check(body, simulation), body)),
      simulation_(simulation),
      scheme_(scheme(simulation.integrator)),
      frequency_(frequency),
      make_(make),
      machine_(make_(local(), simulation_)),
      guides_(local(), origin_.place) {
    State rest{{}, std::vector<dvec3>(body_.count(), dvec3(0))};
    for (vec3 p : local().positions) rest.positions.push_back(origin_.place + dvec3(p));
    put(std::move(rest));
}

Solver::~Solver() = default;

int Solver::steps_for(double seconds, const Influences& influences) const {
    palpate::check(seconds, influences, body_, simulation_);
    return steps_within(seconds, longest_step(influences));
}

void Solver::remember() {
    machine_->remember();
    before_ = {lag_, guides_, origin_, first_node_, first_velocity_};
}

Stats Solver::step(double seconds, const Influences& influences) {
    const int steps = steps_for(seconds, influences);
    remember();
    return advance(seconds, steps, influences);
}

Stats Solver::go_on(double seconds, const Influences& influences) {
    const int steps = steps_for(seconds, influences);
    if (!before_) remember();
    return advance(seconds, steps, influences);
}

// The machine counts from where the body is now.
void Solver::go_along() {
    const Origin next = floating_.beside(first_node_, first_velocity_, origin_);
    if (next == origin_) return;
    machine_->shift(next.place - origin_.place, next.velocity - origin_.velocity);
    origin_ = next;
}

Stats Solver::advance(double seconds, int steps, const Influences& influences) {
    Stats stats;
    stats.steps = steps;
    stats.step = seconds / steps;
    go_along();
    const LocalActs local(influences, guides_.lead(influences, seconds), origin_, seconds);
    Pass constant = make_pass(body_, simulation_, origin_);
    constant.wind = vec4(local.influences.wind, simulation_.air);
    constant.tips = int(influences.presses.size());
    constant.resistance = std::ranges::any_of(influences.presses, resists) ? 1 : 0;
    constant.pushes = influences.pushes.empty() ? 0 : 1;
    const std::vector<NodePush> pushes = by_node(local.influences.pushes);
    const Call call{scheme_,  simulation_, local.influences, local.guides, pushes,
                    constant, stats.step,  stats.steps,      lag_,         origin_};
    Findings found = machine_->run(call);
    shown_ = false;
    lag_ = call.lag_after();
    origin_ = origin_.after(seconds);
    first_node_ = origin_.place + found.first_node;
    first_velocity_ = origin_.velocity + found.first_velocity;
    guides_.arrive();

    stats.diverged = found.torn;
    if (stats.diverged) {
        undo();
        found = {.by_presses = std::vector<dvec3>(influences.presses.size()),
                 .by_pushes = std::vector<dvec3>(influences.pushes.size())};
    }
    stats.largest_speed = found.largest_speed;
    stats.largest_move = found.largest_move;
    for (dvec3 given : found.by_presses) stats.reactions.push_back(dvec3(0) - given);
    for (dvec3 given : found.by_pushes) stats.pushes.push_back(dvec3(0) - given);
    return stats;
}

void Solver::undo() {
    if (!before_) refuse_undo(body_);
    origin_ = before_->origin;
    first_node_ = before_->first_node;
    first_velocity_ = before_->first_velocity;
    machine_->bring_back(origin_);
    lag_ = before_->lag;
    guides_ = before_->guides;
    before_.reset();
    shown_ = false;
}

Nodes Solver::nodes() const {
    if (!shown_) machine_->show(origin_, positions_, normals_);
    shown_ = true;
    return {positions_, normals_};
}

GpuNodes Solver::gpu_nodes() const { return machine_->gpu_nodes(); }

// Half a kick brings up velocities that lie behind.
std::vector<dvec3> Solver::velocities_now() const {
    Pass pass = make_pass(body_, simulation_, origin_);
    pass.kick = float(lag_ / (1 + double(body_.damping) * lag_));
    std::vector<dvec3> velocities = machine_->kicked(pass);
    for (dvec3& v : velocities) v += origin_.velocity;
    return velocities;
}

State Solver::state() const {
    State state = save();
    if (lag_ > 0) state.velocities = velocities_now();
    state.lag = 0;
    return state;
}

State Solver::save() const {
    State state = machine_->get();
    for (dvec3& p : state.positions) p += origin_.place;
    for (dvec3& v : state.velocities) v += origin_.velocity;
    guides_.write_to(state);
    state.lag = lag_;
    return state;
}

void Solver::restore(const State& state) {
    palpate::check(state, body_);
    before_.reset();
    guides_.stand(state);
    put(state);
    lag_ = state.lag;
    if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
        State now = state;
        now.velocities = velocities_now();
        put(now);
        lag_ = 0;
    }
    shown_ = false;
}

void Solver::put(State state) {
    if (!state.positions.empty()) first_node_ = state.positions[0], first_velocity_ = state.velocities[0];
    origin_ = floating_.beside(first_node_, first_velocity_, floating_.first());
    for (dvec3& p : state.positions) p -= origin_.place;
    for (dvec3& v : state.velocities) v -= origin_.velocity;
    machine_->put(state, origin_);
}

BodyChange Solver::change(const Edit& edit) {
    const State before = save();
    const BodyChange change = apply(body_, edit);
    floating_.change(body_);
    frequency_ = highest_frequency(body_);
    longest_ = LongestStep(body_, simulation_, frequency_);
    State now{.positions = {}, .velocities = {}, .lag = before.lag};
    for (int node : change.node_before) {
        now.positions.push_back(before.positions[std::size_t(node)]);
        now.velocities.push_back(before.velocities[std::size_t(node)]);
    }
    guides_ = Guides(local(), floating_.first().place);
    guides_.stand(now);
    before_.reset();
    shown_ = false;
    if (!change.same_nodes() || !machine_->change(change.nodes)) machine_ = make_(local(), simulation_);
    put(now);
    return change;
}

std::size_t Solver::memory() const { return machine_->memory(); }

std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation,
                                    const gl::Context* context, double frequency, Team* team) {
    check(body, simulation);
    if (!(frequency > 0)) frequency = highest_frequency(body);
    if (!std::isfinite(frequency))
        throw Error("masses or springs that are not finite", name_in_errors(body),
                    "give all nodes a mass above zero, and all springs finite stiffness");
    auto solver =
        std::make_unique<Solver>(body, simulation, frequency, machine_for(simulation.backend, context, team));
    solver->longest_step();  // refuses what is never stable
    return solver;
}

std::unique_ptr<Solver> make_exact_solver(const Body& body, const Simulation& simulation, double frequency) {
    Simulation any_step = simulation;
    any_step.force = true;
    any_step.shortest_step = 0;
    return std::make_unique<Solver>(body, any_step, frequency, make_reference<double>);
}

}  // namespace palpate
