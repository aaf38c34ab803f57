#pragma once
#include "palpate/body/body.h"
#include "palpate/body/nodes.h"
#include "palpate/body/press.h"
#include "palpate/body/simulation.h"

#include <memory>
#include <span>
#include <vector>

namespace palpate {

/// What one call of Solver::step did.
struct Stats {
    int steps = 0;
    double step = 0;           // s, the length of each
    double largest_speed = 0;  // m/s, of any node at the end
    bool diverged = false;     // the motion blew up; the state is that from before the call
    std::vector<dvec3>
        reactions;  // N s, one a press: the impulse that the body gave to the tip, and its opposite got
};

/// How many equal steps, none longer than `longest`, fill a time; at least one.
int steps_within(double seconds, double longest);

/// Owns a body's moving state on one backend and moves it. A step never throws.
class Solver {
 public:
    virtual ~Solver() = default;

    /// Moves the body on by `seconds`, in equal steps no longer than the chosen one, with at most 8 tips
    /// pressing.
    virtual Stats step(double seconds, std::span<const Press> presses = {}) = 0;

    /// The longest step that step() would take with these presses, s.
    virtual double longest_step(std::span<const Press> presses) const = 0;

    /// Where the nodes are now; valid until the next step.
    virtual Nodes nodes() const = 0;

    /// Positions and velocities at the same moment, whatever the integrator's own bookkeeping; as if the tips
    /// were lifted just then.
    virtual State state() const = 0;
};

/// Throws Error if a step above the stability bound is asked for without `force`, if a frame would take more
/// than 1,000 steps, or if there are more than 8 planes or 8 spheres.
std::unique_ptr<Solver> make_solver(const Body& body, const Simulation& simulation);

}  // namespace palpate
