#pragma once
#include "palpate/body/simulation.h"

#include <span>

namespace palpate {

/// One pass over all nodes. With x, v where the step began, and x', v', a' at the state that the last pass
/// left (the first pass: where the step began):
///     v_next = v + kick · a',   x_next = x + drift · (v' + lead · (v_next - v')).
/// All four numbers in units of the step.
struct Stage {
    double kick, drift, lead;
    double part = 0;        // the sum over the passes, which starts at (x, v), grows by part · (v', a')
    bool from_sum = false;  // that sum stands for x and v here
};

/// How an integrator makes a step: a line of scheme.cpp, which docs/integrators.md derives.
struct Scheme {
    std::span<const Stage> stages;
    bool staggered = false;     // velocities live half a step behind positions
    bool mean_damping = false;  // damping acts on the mean of the old and the new velocity

    /// s: the time over which a stage's forces act on velocities that are `lag` behind the positions, so that
    /// these end up half a step behind if staggered.
    double reach(const Stage& stage, double step, double lag) const {
        return staggered ? lag + step / 2 : stage.kick * step;
    }
    /// The stage's `kick`, s: that time, shortened by damping that acts on the new velocity too.
    double kick(const Stage& stage, double step, double lag, double damping) const {
        const double way = reach(stage, step, lag);
        const double behind = staggered ? lag : mean_damping ? way / 2 : 0;
        return way / (1 + damping * behind);
    }
};

const Scheme& scheme(Integrator integrator);

}  // namespace palpate
