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

double LongestStep::under(const Influences& influences) {
    if (simulation_.step > 0) return simulation_.step;
    float contact = 0, pull = 0;  // they may all meet at one node
    for (const Press& press : influences.presses) contact += pressure_per_metre(press);
    for (const Drag& drag : influences.drags) pull += drag.stiffness;
    contact = std::max(contact, simulation_.contact);
    pull = std::max(pull, simulation_.pull);
    if (!last_ || last_->contact != contact || last_->pull != pull) {
        const double touched = touched_frequency(body_, frequency_, contact, pull);
        last_ = {contact, pull,
                 automatic_step(simulation_.integrator, touched, body_.damping, body_.link_damping)};
    }
    return last_->step;
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

}  // namespace palpate
