#pragma once
#include "palpate/body/influences.h"
#include "palpate/solver/guides.h"
#include "palpate/solver/pass.h"
#include "palpate/solver/scheme.h"

#include <span>

namespace palpate {

/// The states of a body that a machine keeps. A step begins at `current`. Its passes write between and
/// further alternately; the last of several writes over `current`, whose neighbours are no longer read.
/// The only one of a step writes between, and the two buffers are swapped.
enum StateBuffer { current, between, further, sum };

/// Which of them a scheme needs, so that a backend keeps no more: a node costs as much for each.
bool needs(const Scheme& scheme, StateBuffer where);

/// What a machine must know of a pass besides its numbers.
struct PassPlan {
    StateBuffer start, at, next;  // where it starts from; where forces are taken; where it writes
    bool opens;                   // the first of a step
    bool ends;                    // the last of a call
    double impulse;               // s, over which its forces give momentum to the nodes
    std::span<const RoundTip> tips = {};
};

/// One call of Solver::step, as every machine goes through it: so many steps, of each the stages of the
/// scheme, of each one pass over all nodes. Places and velocities are counted from its origin; guides lead to
/// places counted from where that is at the end.
struct Call {
    const Scheme& scheme;
    const Simulation& simulation;
    const Influences& influences;
    std::span<const Guide> guides;     // of the nodes of inverse mass 0
    std::span<const NodePush> pushes;  // all of each node together
    Pass constant;                     // what all of its passes have alike
    double step;                       // s
    int steps;
    double lag;  // s, of the velocities when it begins
    Origin origin;

    /// Runs every pass of every step in plan, run(const Pass&, const PassPlan&): the neighbours move too.
    /// Tools and colliders stand where they are by then.
    template <class Run>
    void for_each_pass(Run run) const {
        Pass pass = constant;
        std::vector<RoundTip> tips;
        for (int i = 0; i < steps; ++i) {
            double reached = 0;  // by the last stage, in steps
            StateBuffer at = current;
            for (const Stage& stage : scheme.stages) {
                const bool last = &stage == &scheme.stages.back();
                const double behind = i == 0 ? lag : lag_after();
                pass.kick = float(scheme.kick(stage, step, behind, constant.damping));
                pass.drift = float(stage.drift * step);
                pass.lead = float(stage.lead);
                pass.part = float(stage.part * step);
                pass.time = float((i + reached) * step);
                place_tips(tips, influences, (i + reached) * step);
                const double impulse = last ? scheme.reach(stage, step, behind) : stage.part * step;
                reached = last ? 1 : stage.drift;
                pass.last = last ? (i + 1 == steps ? 2 : 1) : 0;
                pass.duration = float(reached * step);
                place_obstacles(pass, simulation, influences, (i + reached) * step, origin);
                const StateBuffer next = last && at != current ? current : at == between ? further : between;
                run(pass, PassPlan{stage.from_sum ? sum : current, at, next, at == current,
                                   last && i + 1 == steps, impulse, tips});
                at = next;
            }
        }
    }

    /// s, of the velocities when it has ended.
    double lag_after() const { return scheme.staggered ? step / 2 : 0; }
};

}  // namespace palpate
