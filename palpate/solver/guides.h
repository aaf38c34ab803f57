#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"

#include <span>
#include <vector>

namespace palpate {

/// What leads a node of inverse mass 0 through a call: it keeps this velocity, whatever pulls.
struct Guide {
    int node;
    dvec3 velocity = dvec3(0);  // m/s
    dvec3 to = dvec3(0);        // m, where the call leaves it, which takes the rounding of many steps away,
    bool is_led = false;        // unless it does not move
};

/// The guides of all nodes of inverse mass 0, in their order. It remembers where they stand, so that nothing
/// has to ask the machine.
class Guides {
 public:
    /// `origin`: m, of the body's places.
    Guides(const Body& body, dvec3 origin);

    /// The nodes are there now.
    void stand(const State& state);
    /// Where they are, exactly: a machine may have had to round it.
    void write_to(State& state) const;

    /// Leads them through a call of `seconds` towards where the moves say.
    std::span<const Guide> lead(const Influences& influences, double seconds);

    /// They have arrived.
    void arrive();

 private:
    std::vector<int> guide_of_;  // each node's, or -1
    std::vector<Guide> guides_;
    std::vector<dvec3> at_;  // m, where they stand
};

}  // namespace palpate
