#include "palpate/solver/scheme.h"

namespace palpate {
namespace {

// kick, drift, lead, part, from_sum
constexpr Stage euler[] = {{1, 1, 0}};
constexpr Stage kick_then_drift[] = {{1, 1, 1}};
constexpr Stage by_the_middle[] = {{0.5, 0.5, 0}, {1, 1, 0}};
constexpr Stage drift_kick_drift[] = {{0, 0.5, 0}, {1, 1, 0.5}};
constexpr Stage runge_kutta[] = {
    {0.5, 0.5, 0, 1 / 6.0}, {0.5, 0.5, 0, 1 / 3.0}, {1, 1, 0, 1 / 3.0}, {1 / 6.0, 1 / 6.0, 0, 0, true}};

constexpr Scheme schemes[] = {
    /* explicit_euler      */ {euler},
    /* semi_implicit_euler */ {kick_then_drift},
    /* verlet              */ {kick_then_drift, true, true},
    /* midpoint            */ {by_the_middle},
    /* verlet_midpoint     */ {drift_kick_drift, false, true},
    /* rk4                 */ {runge_kutta},
};

}  // namespace

const Scheme& scheme(Integrator integrator) { return schemes[std::size_t(integrator)]; }

}  // namespace palpate
