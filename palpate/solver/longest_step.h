#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"
#include "palpate/body/simulation.h"

#include <optional>

namespace palpate {

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

}  // namespace palpate
