#include "palpate/solver/solver.h"

#include "palpate/base/error.h"
#include "palpate/solver/reference/reference.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double most_steps_per_frame = 1000;

void check_step(const Body& body, const Simulation& simulation, double frequency) {
    const double pressed = pressed_frequency(body, frequency, simulation.contact);
    const double bound = longest_step(simulation.integrator, pressed, body.damping);
    const std::string where = body.name.empty() ? "the body" : "body " + body.name;
    if (simulation.step > bound && !simulation.force)
        throw Error(fmt::format("a step of {:.4g} s is above {}'s stability bound of {:.4g} s",
                                simulation.step, name_of(simulation.integrator), bound),
                    where, "use step = \"auto\" or a shorter one, or --force to see it blow up");
    const double step = simulation.step > 0 ? simulation.step : step_safety * bound;
    if (!(simulation.frame / step <= most_steps_per_frame))
        throw Error(
            fmt::format("{} would need {:.0f} steps of {:.3g} s for a frame of {:.3g} s",
                        name_of(simulation.integrator), simulation.frame / step, step, simulation.frame),
            where, "use a softer material, a larger spacing or a heavier body, and check its units");
}

void check_colliders(const Simulation& simulation) {
    int planes = 0;
    for (const Collider& collider : simulation.colliders) planes += std::holds_alternative<Plane>(collider);
    const int spheres = int(simulation.colliders.size()) - planes;
    if (planes > 8 || spheres > 8)
        throw Error(fmt::format("{} planes and {} spheres", planes, spheres), "the colliders",
                    "use at most 8 of each kind");
}

}  // namespace

int steps_within(double seconds, double longest) {
    return std::max(1, int(std::ceil(seconds / longest - 1e-6)));  // a hair of rounding is not worth a step
}

std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation) {
    const double frequency = highest_frequency(body);
    check_step(body, simulation, frequency);
    check_colliders(simulation);
    switch (simulation.backend) {
        case Backend::reference:
            return make_reference<float>(body, simulation, frequency);
    }
    return nullptr;
}

}  // namespace palpate
