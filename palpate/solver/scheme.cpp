#include "palpate/solver/scheme.h"

#include "palpate/base/error.h"

namespace palpate {
namespace {

// kick, drift, lead, part, from_sum
constexpr Stage euler[] = {{1, 1, 0}};
constexpr Stage kick_then_drift[] = {{1, 1, 1}};
constexpr Stage by_the_middle[] = {{0.5, 0.5, 0}, {1, 1, 0}};
constexpr Stage drift_kick_drift[] = {{0, 0.5, 0}, {1, 1, 0.5}};
constexpr Stage runge_kutta[] = {
    {0.5, 0.5, 0, 1 / 6.0}, {0.5, 0.5, 0, 1 / 3.0}, {1, 1, 0, 1 / 3.0}, {1 / 6.0, 1 / 6.0, 0, 0, true}};

constexpr Scheme explicit_euler{euler};
constexpr Scheme semi_implicit_euler{kick_then_drift};
constexpr Scheme verlet{kick_then_drift, true, true};
constexpr Scheme midpoint{by_the_middle};
constexpr Scheme verlet_midpoint{drift_kick_drift, false, true};
constexpr Scheme rk4{runge_kutta};

}  // namespace

const Scheme& scheme(Integrator integrator) {
    switch (integrator) {
        case Integrator::explicit_euler:
            return explicit_euler;
        case Integrator::semi_implicit_euler:
            return semi_implicit_euler;
        case Integrator::verlet:
            return verlet;
        case Integrator::midpoint:
            return midpoint;
        case Integrator::verlet_midpoint:
            return verlet_midpoint;
        case Integrator::rk4:
            return rk4;
    }
    throw Error("an integrator that there is not", "the simulation",
                "choose one of " + all_names<Integrator>());
}

}  // namespace palpate
