#pragma once
#include "palpate/body/edit.h"
#include "palpate/body/influences.h"
#include "palpate/body/nodes.h"
#include "palpate/body/simulation.h"
#include "palpate/solver/guides.h"
#include "palpate/solver/longest_step.h"
#include "palpate/solver/origin.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace palpate {

namespace gl {
class Context;
}
class Machine;
class Team;
struct Scheme;

/// What one call of Solver::step did.
struct Stats {
    int steps = 0;
    double step = 0;           // s, the length of each
    double largest_speed = 0;  // m/s, of any node at the end
    double largest_move = 0;   // m, of any node in the last step
    bool diverged = false;     // the motion blew up; the state is that from before the call
    std::vector<dvec3>
        reactions;  // N s, one a press: the impulse that the body gave to the tip; its opposite it got
    std::vector<dvec3> pushes;  // N s, one a push, likewise
};

/// How many equal steps, none longer than `longest`, fill a time; at least one. Throws Error
/// where they would be more than a billion.
int steps_within(double seconds, double longest);

/// Owns a body's moving state and moves it: what a step is, on whatever machine. What happens in a step never
/// throws, unless a graphics card is lost; what a caller hands in is looked at before anything moves.
class Solver final {
 public:
    using MakeMachine = std::function<std::unique_ptr<Machine>(const Body&, const Simulation&)>;

    /// On a machine of the caller's choice; no step is too long here. Throws Error if body or simulation hold
    /// what cannot be (check()). `frequency`: the body's highest, rad/s.
    Solver(const Body& body, const Simulation& simulation, double frequency, const MakeMachine& make);
    ~Solver();
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    /// Moves the body on by `seconds`, in equal steps no longer than the chosen one. Throws Error, and
    /// nothing has moved, where `seconds` is not above zero or would be more than a billion steps, an
    /// influence is not finite or names a node that the body does not have, colliders have not one motion
    /// each, or tools are so stiff that the step is above its bound, or would be too short (LongestStep).
    Stats step(double seconds, const Influences& influences = {});

    /// The same, but undo() then puts back what was before the last call of step(), if it can still do so:
    /// for a call in parts.
    Stats go_on(double seconds, const Influences& influences = {});

    /// How many steps step() would take. Throws Error as that does.
    int steps_for(double seconds, const Influences& influences) const;

    /// The longest step that step() would take with these, s. Throws Error where it would refuse them.
    double longest_step(const Influences& influences = {}) const { return longest_.under(influences); }

    /// The highest frequency of the body's free motion, rad/s (stability.h).
    double frequency() const { return frequency_; }

    /// Puts back what was before the last call of step(). Throws Error where that is put back already: after
    /// restore(), or when the motion blew up.
    void undo();

    /// Where the nodes are now; valid until the next step. From a GPU they are read back, once a step.
    Nodes nodes() const;

    /// The same where they are, on a GPU; valid until the next step. None from a machine of the CPU.
    GpuNodes gpu_nodes() const;

    /// Positions and velocities at the same moment, whatever the integrator's own bookkeeping; as if tips,
    /// pushes, wind and colliders were gone just then: with Verlet a node at rest on the ground shows half a
    /// step of gravity.
    State state() const;

    /// The state as the integrator keeps it, to the bit: going on from it after restore() is going on from
    /// here. Of a body that has gone farther than twice its size (origin.h) the last bits may differ.
    State save() const;

    /// Goes on from a state of the same body, from save() or state() of any integrator and machine. Throws
    /// Error if it is of another number of nodes.
    void restore(const State& state);

    /// Cuts springs and cells out of the body while it moves (body/edit.h). The state of all nodes that are
    /// left stays to the bit, and memory is rewritten only for what changed, where the machine can do so.
    /// What was before cannot be put back by undo(). Throws Error, and nothing has changed, as apply() does.
    BodyChange change(const Edit& edit);

    const Body& body() const { return body_; }

    /// Bytes that the moving state and the springs take on this machine.
    std::size_t memory() const;

 private:
    // What a call began with, besides the machine's own.
    struct Before {
        double lag;
        Guides guides;
        Origin origin;
        dvec3 first_node, first_velocity;
    };
    void remember();
    Stats advance(double seconds, int steps, const Influences& influences);
    void put(State state);
    std::vector<dvec3> velocities_now() const;
    const Body& local() const { return floating_.local(body_); }
    void go_along();

    Body body_;
    const Simulation simulation_;
    const Scheme& scheme_;
    double frequency_;  // rad/s, the highest of the body with nothing touching it
    FloatingOrigin floating_{body_};
    Origin origin_ = floating_.first();                        // of the machine's places and velocities
    dvec3 first_node_ = dvec3(0), first_velocity_ = dvec3(0);  // m, m/s, in the world
    mutable LongestStep longest_{body_, simulation_, frequency_};
    const MakeMachine make_;
    std::unique_ptr<Machine> machine_;
    Guides guides_;                                  // in the world
    double lag_ = 0;                                 // s, how far the velocities are behind the positions
    std::optional<Before> before_;                   // the last call, if that can be put back
    mutable std::vector<vec3> positions_, normals_;  // what nodes() shows
    mutable bool shown_ = false;
};

/// Throws Error if body or simulation hold what cannot be (check()), if a step above the stability bound is
/// asked for without `force`, if the integrator has none without damping, if steps would be shorter than
/// Simulation::shortest_step, or if there are more colliders than fit. A backend of the GPU works in
/// `context`, which has to outlive the solver, or if there is none in one of its own; it throws Error if
/// there is no OpenGL. `frequency`: the body's highest, if it is known; finding it takes longer than all the
/// rest. `team`: that the backend cpu works with, in place of one of its own; it has to outlive the solver.
std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation,
                                    const gl::Context* context = nullptr, double frequency = 0,
                                    Team* team = nullptr);

/// The reference in double, which shows orders of convergence without rounding in the way. It takes any step;
/// `frequency` is needed where it shall choose one.
std::unique_ptr<Solver> make_exact_solver(const Body& body, const Simulation& simulation,
                                          double frequency = 0);

}  // namespace palpate
