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
            throw Error("this build of Palpate is without its part opengl",
                        fmt::format("the backend {}", name_of(backend)),
                        "use the backend cpu, or build with -D PALPATE_PARTS=all");
#endif
    }
    throw Error("a backend that there is not", "the simulation", "choose one of " + all_names<Backend>());
}

}  // namespace

int steps_within(double seconds, double longest) {
    const double steps = std::ceil(seconds / longest - 1e-6);  // a hair of rounding is not worth a step
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
      machine_(make_(body_, simulation_)),
      guides_(body_) {}

Solver::~Solver() = default;

int Solver::steps_for(double seconds, const Influences& influences) const {
    palpate::check(seconds, influences, body_, simulation_);
    return steps_within(seconds, longest_step(influences));
}

void Solver::remember() {
    machine_->remember();
    before_ = {lag_, guides_};
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

Stats Solver::advance(double seconds, int steps, const Influences& influences) {
    Stats stats;
    stats.steps = steps;
    stats.step = seconds / steps;
    Pass constant = make_pass(body_, simulation_);
    constant.wind = vec4(influences.wind, simulation_.air);
    constant.tips = int(influences.presses.size());
    constant.pushes = influences.pushes.empty() ? 0 : 1;
    const std::vector<NodePush> pushes = by_node(influences.pushes);
    const Call call{scheme_,    simulation_, influences, guides_.lead(influences, seconds), pushes, constant,
                    stats.step, stats.steps, lag_};
    Findings found = machine_->run(call);
    shown_ = false;
    lag_ = call.lag_after();
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
    machine_->bring_back();
    lag_ = before_->lag;
    guides_ = before_->guides;
    before_.reset();
    shown_ = false;
}

Nodes Solver::nodes() const {
    if (!shown_) machine_->show(positions_, normals_);
    shown_ = true;
    return {positions_, normals_};
}

GpuNodes Solver::gpu_nodes() const { return machine_->gpu_nodes(); }

// Half a kick brings up velocities that lie behind.
std::vector<dvec3> Solver::velocities_now() const {
    return machine_->kicked(lag_ / (1 + double(body_.damping) * lag_));
}

State Solver::state() const {
    State state = save();
    if (lag_ > 0) state.velocities = velocities_now();
    state.lag = 0;
    return state;
}

State Solver::save() const {
    State state = machine_->get();
    guides_.tell(state);
    state.lag = lag_;
    return state;
}

void Solver::restore(const State& state) {
    palpate::check(state, body_);
    before_.reset();
    guides_.stand(state);
    machine_->put(state);
    lag_ = state.lag;
    if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
        State now = state;
        now.velocities = velocities_now();
        machine_->put(now);
        lag_ = 0;
    }
    shown_ = false;
}

BodyChange Solver::change(const Edit& edit) {
    const State before = save();
    const BodyChange change = apply(body_, edit);
    frequency_ = highest_frequency(body_);
    longest_ = LongestStep(body_, simulation_, frequency_);
    State now{.positions = {}, .velocities = {}, .lag = before.lag};
    for (int node : change.node_before) {
        now.positions.push_back(before.positions[std::size_t(node)]);
        now.velocities.push_back(before.velocities[std::size_t(node)]);
    }
    guides_ = Guides(body_);
    guides_.stand(now);
    before_.reset();
    shown_ = false;
    if (change.same_nodes() && machine_->change(change.nodes)) return change;
    std::unique_ptr<Machine> next = make_(body_, simulation_);
    next->put(now);
    machine_ = std::move(next);
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
