#include "palpate/solver/solver.h"

#include "palpate/base/error.h"
#include "palpate/solver/check.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/short_steps.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double most_steps_per_frame = 1000;

void check_step(const Body& body, const Simulation& simulation, double frequency) {
    const double touched = touched_frequency(body, frequency, simulation.contact, simulation.pull);
    const auto integrator = simulation.integrator;
    const double bound = longest_step(integrator, touched, body.damping, body.link_damping);
    const std::string where = name_in_errors(body);
    if (simulation.step > bound && !simulation.force)
        throw Error(fmt::format("a step of {:.4g} s is above {}'s stability bound of {:.4g} s",
                                simulation.step, name_of(integrator), bound),
                    where, "use step = \"auto\" or a shorter one, or --force to see it blow up");
    if (simulation.step <= 0 && !(bound > 0))
        throw Error(fmt::format("{} is stable at no step without damping", name_of(integrator)), where,
                    "choose verlet, which needs none");
    const double automatic = automatic_step(integrator, touched, body.damping, body.link_damping);
    const double step = simulation.step > 0 ? simulation.step : automatic;
    const double wanted = simulation.frame / most_steps_per_frame;
    if (step >= wanted) return;
    throw Error(fmt::format("{} would need {:.0f} steps of {:.3g} s for a frame of {:.3g} s",
                            name_of(integrator), simulation.frame / step, step, simulation.frame),
                where,
                step < automatic ? fmt::format("ask for longer steps: up to {:.3g} s are stable", bound)
                                 : how_to_lengthen_steps(body, simulation, frequency, wanted));
}

Solver::MakeMachine machine_for(Backend backend, const gl::Context* context) {
    switch (backend) {
        case Backend::reference:
            return make_reference<float>;
        case Backend::cpu:
            return [](const Body& body, const Simulation& simulation) { return make_cpu(body, simulation); };
        case Backend::feedback:
        case Backend::fragment:
        case Backend::compute:
            return [=](const Body& body, const Simulation& simulation) {
                return make_gpu(body, simulation, context);
            };
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
    : body_((check(body, simulation), body)),
      simulation_(simulation),
      scheme_(scheme(simulation.integrator)),
      frequency_(frequency),
      machine_(make(body_, simulation_)),
      guides_(body_) {}

Solver::~Solver() = default;

Stats Solver::step(double seconds, const Influences& influences) {
    check(seconds, influences, body_, simulation_);
    Stats stats;
    stats.steps = steps_within(seconds, longest_step(influences));
    stats.step = seconds / stats.steps;

    machine_->remember();
    before_ = {lag_, guides_};
    Pass constant = make_pass(body_, simulation_);
    constant.wind = vec4(influences.wind, simulation_.air);
    const Call call{scheme_,  simulation_, influences,  guides_.lead(influences.moves, seconds),
                    constant, stats.step,  stats.steps, lag_};
    Findings found = machine_->run(call);
    shown_ = false;
    lag_ = call.lag_after();
    guides_.arrive();

    stats.diverged = found.torn;
    if (stats.diverged) {
        undo();
        found = {.by_presses = std::vector<dvec3>(influences.presses.size()),
                 .by_drags = std::vector<dvec3>(influences.drags.size())};
    }
    stats.largest_speed = found.largest_speed;
    stats.largest_move = found.largest_move;
    for (dvec3 given : found.by_presses) stats.reactions.push_back(dvec3(0) - given);
    for (dvec3 given : found.by_drags) stats.pulls.push_back(dvec3(0) - given);
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
    state.lag = lag_;
    return state;
}

void Solver::restore(const State& state) {
    check(state, body_);
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

std::size_t Solver::memory() const { return machine_->memory(); }

std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation,
                                    const gl::Context* context, double frequency) {
    check(body, simulation);
    if (!(frequency > 0)) frequency = highest_frequency(body);
    if (!std::isfinite(frequency))
        throw Error("masses or springs that are not finite", name_in_errors(body),
                    "give all nodes a mass above zero, and all springs finite stiffness");
    check_step(body, simulation, frequency);
    return std::make_unique<Solver>(body, simulation, frequency, machine_for(simulation.backend, context));
}

std::unique_ptr<Solver> make_exact_solver(const Body& body, const Simulation& simulation, double frequency) {
    return std::make_unique<Solver>(body, simulation, frequency, make_reference<double>);
}

}  // namespace palpate
