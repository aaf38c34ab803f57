#pragma once
#include "palpate/body/body.h"

#include <memory>
#include <span>

namespace palpate {

/// The forces of a body's terms by themselves, in double, of any shape: what the stability bound, reports and
/// other people's solvers ask. They come from the same text as every step (solver/terms/). Lists are one
/// entry a node. at() and stiffness_times() work on all processors. All throw Error where a list is of
/// another length.
class Forces {
 public:
    /// Throws Error if the body does not hold (check(body)). Keeps what it needs of the body.
    explicit Forces(const Body& body);
    ~Forces();

    /// N, on each node at these positions, m; without gravity, damping and all that acts from outside.
    void at(std::span<const dvec3> positions, std::span<dvec3> forces) const;

    /// The stiffness matrix about these positions times a displacement, N: minus the derivative of the
    /// forces, but for what would make it negative (terms/).
    void stiffness_times(std::span<const dvec3> positions, std::span<const dvec3> displacement,
                         std::span<dvec3> forces) const;

    /// J.
    double energy(std::span<const dvec3> positions) const;

 private:
    struct Inside;
    std::unique_ptr<Inside> in_;
};

/// What motion and the body's terms hold.
struct Energy {
    double kinetic = 0;  // J
    double elastic = 0;  // J, in the body's terms
};
/// `state`: with velocities at the time of the positions.
Energy energy(const Body& body, const State& state);

}  // namespace palpate
