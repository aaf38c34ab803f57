#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"
#include "palpate/body/simulation.h"

#include <optional>

namespace palpate {

/// How stiffly tools hold a body at one moment: all that they change about its stability.
struct ToolStiffness {
    float contact = 0;  // Pa/m, of all presses together: they may meet at one node
    float pull = 0;     // N/m, of all pushes of that node which they hold most stiffly
    bool operator==(const ToolStiffness&) const = default;
};
ToolStiffness tool_stiffness(const Influences& influences);

/// The longest step that a solver takes under influences. Finding it takes longer than a step of a small body
/// does, so it is found again only when what it depends on has changed.
class LongestStep {
 public:
    /// `frequency`: the body's highest, rad/s. Body and simulation have to outlive it.
    LongestStep(const Body& body, const Simulation& simulation, double frequency)
        : body_(&body), simulation_(&simulation), frequency_(frequency) {}

    /// s. Throws Error where the step that was asked for is above the bound, without Simulation::force; where
    /// the integrator has no bound; and where steps would be shorter than Simulation::shortest_step.
    double under(const Influences& influences);

 private:
    double find(const ToolStiffness& tools) const;

    struct Found {
        ToolStiffness tools;
        double step;
    };

    const Body* body_;
    const Simulation* simulation_;
    double frequency_;
    std::optional<Found> last_;
};

}  // namespace palpate
