#pragma once
#include "palpate/solver/pass.h"
#include "palpate/solver/scheme.h"
#include "palpate/solver/solver.h"

#include <optional>

namespace palpate {

/// The states of a body that a backend keeps. A step begins at `current`. Its passes write between and
/// further by turns; the last of several writes over `current`, whose neighbours nobody looks at any more.
/// The only one of a step writes between, and the two change places.
enum Where { current, between, further, sum };

/// Which of them a scheme needs, so that a backend keeps no more: a node costs as much for each.
bool needs(const Scheme& scheme, Where where);

/// One pass over all nodes.
struct Turn {
    Where start, at, next;  // where it starts from; where forces are taken; where it writes
    bool opens;             // the first of a step
    bool ends;              // the last of a call
    double impulse;         // s, over which its forces give momentum to the nodes
};

/// One call of Solver::step, as every backend goes through it.
struct Call {
    const Scheme& scheme;
    const Simulation& simulation;
    const Influences& influences;
    double damping;  // 1/s, the body's
    double step;     // s
    int steps;
    double lag;  // s, of the velocities when it begins

    /// Runs every pass of every step in turn, run(const Pass&, const Turn&): the neighbours move too. Tools
    /// and colliders stand where they are by then.
    template <class Run>
    void for_each_pass(Pass pass, Run run) const {
        for (int i = 0; i < steps; ++i) {
            double reached = 0;  // by the last stage, in steps
            Where at = current;
            for (const Stage& stage : scheme.stages) {
                const bool last = &stage == &scheme.stages.back();
                const double behind = i == 0 ? lag : lag_after();
                pass.kick = float(scheme.kick(stage, step, behind, damping));
                pass.drift = float(stage.drift * step);
                pass.lead = float(stage.lead);
                pass.part = float(stage.part * step);
                place_tools(pass, influences, (i + reached) * step);
                const double impulse = last ? scheme.reach(stage, step, behind) : stage.part * step;
                reached = last ? 1 : stage.drift;
                pass.last = last ? (i + 1 == steps ? 2 : 1) : 0;
                pass.duration = float(reached * step);
                place_obstacles(pass, simulation, influences, (i + reached) * step);
                const Where next = last && at != current ? current : at == between ? further : between;
                run(pass, Turn{stage.from_sum ? sum : current, at, next, at == current,
                               last && i + 1 == steps, impulse});
                at = next;
            }
        }
    }

    /// s, of the velocities when it has ended.
    double lag_after() const { return scheme.staggered ? step / 2 : 0; }
};

/// The longest step that a solver takes under influences. Finding it takes longer than a step of a small body
/// does, so it is found again only when what it depends on has changed: how strong presses and drags are.
class LongestStep {
 public:
    /// `frequency`: the body's highest, rad/s. Body and simulation have to outlive it.
    LongestStep(const Body& body, const Simulation& simulation, double frequency)
        : body_(body), simulation_(simulation), frequency_(frequency) {}

    double under(const Influences& influences);  // s

 private:
    struct Found {
        float contact, pull;
        double step;
    };

    const Body& body_;
    const Simulation& simulation_;
    double frequency_;
    std::optional<Found> last_;
};

/// What a call is about to report: its steps, no longer than `longest` (s), and nothing yet of what they do.
Stats about_to_do(const Influences& influences, double seconds, double longest);

/// What it reports if the motion has blown up and all is as it was before.
Stats undone(const Stats& stats);

}  // namespace palpate
