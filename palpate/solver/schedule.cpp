#include "palpate/solver/schedule.h"

#include "palpate/solver/stability.h"

#include <algorithm>

namespace palpate {

bool needs(const Scheme& scheme, Where where) {
    switch (where) {
        case current:
        case between:
            return true;
        case further:
            return scheme.stages.size() > 2;
        case sum:
            return scheme.stages.front().part > 0;
    }
    return false;
}

double step_under(const Influences& influences, const Body& body, const Simulation& simulation,
                  double frequency) {
    if (simulation.step > 0) return simulation.step;
    float contact = 0, pull = 0;  // they may all meet at one node
    for (const Press& press : influences.presses) contact += pressure_per_metre(press);
    for (const Drag& drag : influences.drags) pull += drag.stiffness;
    const double touched = touched_frequency(body, frequency, std::max(contact, simulation.contact),
                                             std::max(pull, simulation.pull));
    return automatic_step(simulation.integrator, touched, body.damping, body.link_damping);
}

Stats about_to_do(const Influences& influences, double seconds, double longest) {
    Stats stats;
    stats.reactions.assign(influences.presses.size(), dvec3(0));
    stats.pulls.assign(influences.drags.size(), dvec3(0));
    stats.steps = steps_within(seconds, longest);
    stats.step = seconds / stats.steps;
    return stats;
}

Stats undone(const Stats& stats) {
    Stats nothing;
    nothing.steps = stats.steps;
    nothing.step = stats.step;
    nothing.diverged = true;
    nothing.reactions.assign(stats.reactions.size(), dvec3(0));
    nothing.pulls.assign(stats.pulls.size(), dvec3(0));
    return nothing;
}

bool names_nodes(const Influences& influences, const Body& body) {
    auto known = [&](int node) { return node >= 0 && std::size_t(node) < body.count(); };
    for (const Drag& drag : influences.drags)
        if (!known(drag.node)) return false;
    for (const Move& move : influences.moves)
        if (move.nodes.size() != move.to.size() || !std::all_of(move.nodes.begin(), move.nodes.end(), known))
            return false;
    return true;
}

}  // namespace palpate
