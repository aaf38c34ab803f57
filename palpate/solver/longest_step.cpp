#include "palpate/solver/longest_step.h"

#include "palpate/solver/stability.h"

#include <algorithm>

namespace palpate {

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

}  // namespace palpate
