#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"
#include "palpate/body/nodes.h"
#include "palpate/body/simulation.h"

#include <memory>
#include <vector>

namespace palpate {

namespace gl {
class Context;
}

/// What one call of Solver::step did.
struct Stats {
    int steps = 0;
    double step = 0;           // s, the length of each
    bool late = false;         // what follows tells of the call before this one (Simulation::late)
    double largest_speed = 0;  // m/s, of any node at the end
    double largest_move = 0;   // m, of any node in the last step
    bool diverged = false;     // the motion blew up; the state is that from before the call that it tells of
    std::vector<dvec3>
        reactions;  // N s, one a press: the impulse that the body gave to the tip; its opposite it got
    std::vector<dvec3> pulls;  // N s, one a drag, likewise
};

/// How many equal steps, none longer than `longest`, fill a time; at least one. Throws Error
/// where they would be more than a billion.
int steps_within(double seconds, double longest);

/// Owns a body's moving state on one backend and moves it. What happens in a step never throws, unless a
/// graphics card is lost; what a caller hands in is looked at before anything moves.
class Solver {
 public:
    virtual ~Solver() = default;

    /// Moves the body on by `seconds`, in equal steps no longer than the chosen one. Throws Error, and
    /// nothing has moved, where `seconds` is not above zero or would be more than a billion steps, more act
    /// than most_presses or most_drags, an influence is not finite or names a node that the body does not
    /// have, or colliders have not one motion each.
    virtual Stats step(double seconds, const Influences& influences = {}) = 0;

    /// The longest step that step() would take with these, s.
    virtual double longest_step(const Influences& influences = {}) const = 0;

    /// The highest frequency of the body's free motion, rad/s (stability.h).
    virtual double frequency() const = 0;

    /// Puts back what was before the last call of step(). Throws Error where that is put back already: after
    /// restore(), or when the motion blew up.
    virtual void undo() = 0;

    /// Where the nodes are now; valid until the next step. From a GPU they are read back, once a step.
    virtual Nodes nodes() const = 0;

    /// The same where they are, on a GPU; valid until the next step. None from a backend of the CPU.
    virtual GpuNodes gpu_nodes() const { return {}; }

    /// Positions and velocities at the same moment, whatever the integrator's own bookkeeping; as if tips,
    /// drags, wind and colliders were gone just then: with Verlet a node at rest on the ground shows half a
    /// step of gravity.
    virtual State state() const = 0;

    /// The state as the integrator keeps it, to the bit: going on from it after restore() is going on from
    /// here.
    virtual State save() const = 0;

    /// Goes on from a state of the same body, from save() or state() of any integrator and backend. Throws
    /// Error if it is of another number of nodes.
    virtual void restore(const State& state) = 0;

    /// Bytes that the moving state and the springs take on this backend.
    virtual std::size_t memory() const = 0;
};

/// Throws Error if body or simulation hold what cannot be (check()), if a step above the stability bound is
/// asked for without `force`, if the integrator has none without damping, if a frame would take more than
/// 1,000 steps, or if there are more colliders than fit. A backend of the GPU works in `context`, which has
/// to outlive the solver, or if there is none in one of its own; it throws Error if there is no OpenGL.
/// `frequency`: the body's highest, if it is known; finding it takes longer than all the rest.
std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation,
                                    const gl::Context* context = nullptr, double frequency = 0);

}  // namespace palpate
