#include "palpate/solver/solver.h"

#include "palpate/base/error.h"
#include "palpate/solver/check.h"
#include "palpate/solver/cpu/cpu.h"
#include "palpate/solver/gpu/gpu.h"
#include "palpate/solver/reference/reference.h"
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

}  // namespace

int steps_within(double seconds, double longest) {
    const double steps = std::ceil(seconds / longest - 1e-6);  // a hair of rounding is not worth a step
    if (!(steps <= 1e9))
        throw Error(fmt::format("{:.3g} steps of {:.3g} s for {:.3g} s", steps, longest, seconds),
                    "a call of step()", "step by less at once");
    return int(std::max(steps, 1.0));
}

std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation,
                                    const gl::Context* context, double frequency) {
    check(body, simulation);
    if (!(frequency > 0)) frequency = highest_frequency(body);
    if (!std::isfinite(frequency))
        throw Error("masses or springs that are not finite", name_in_errors(body),
                    "give all nodes a mass above zero, and all springs finite stiffness");
    check_step(body, simulation, frequency);
    switch (simulation.backend) {
        case Backend::reference:
            return make_reference<float>(body, simulation, frequency);
        case Backend::cpu:
            return make_cpu(body, simulation, frequency);
        case Backend::feedback:
        case Backend::fragment:
        case Backend::compute:
            return make_gpu(body, simulation, frequency, context);
    }
    throw Error("a backend that there is not", "the simulation", "choose one of " + all_names<Backend>());
}

}  // namespace palpate
