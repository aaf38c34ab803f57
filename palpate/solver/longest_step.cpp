#include "palpate/solver/longest_step.h"

#include "palpate/base/error.h"
#include "palpate/solver/pushes.h"
#include "palpate/solver/short_steps.h"
#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace palpate {

ToolStiffness tool_stiffness(const Influences& influences) {
    ToolStiffness tools;
    for (const Press& press : influences.presses) tools.contact += pressure_per_metre(press);
    for (const NodePush& push : by_node(influences.pushes)) {
        tools.pull = std::max(tools.pull, push.stiffness);
    }
    return tools;
}

double LongestStep::under(const Influences& influences) {
    const ToolStiffness tools = tool_stiffness(influences);
    if (!last_ || last_->tools != tools) last_ = {tools, find(tools)};
    return last_->step;
}

double LongestStep::find(const ToolStiffness& tools) const {
    const Integrator integrator = simulation_->integrator;
    const double frequency = touched_frequency(*body_, frequency_, tools.contact, tools.pull);
    const double bound = longest_step(integrator, frequency, body_->damping, body_->link_damping),
                 automatic = automatic_step(integrator, frequency, body_->damping, body_->link_damping,
                                            frequency_reserve(*body_));
    const std::string where = name_in_errors(*body_);
    if (simulation_->step > bound && !simulation_->force)
        throw Error(fmt::format("a step of {:.4g} s is above {}'s stability bound of {:.4g} s",
                                simulation_->step, name_of(integrator), bound),
                    where, "use step = \"auto\" or a shorter one, or --force to see it blow up");
    if (simulation_->step <= 0 && !(bound > 0))
        throw Error(fmt::format("{} is stable at no step without damping", name_of(integrator)), where,
                    "choose verlet, which needs none");
    const double step = simulation_->step > 0 ? simulation_->step : automatic;
    if (step >= simulation_->shortest_step) return step;
    throw Error(fmt::format("{} would need {:.0f} steps of {:.3g} s for a frame of 1/60 s",
                            name_of(integrator), frame_seconds / step, step),
                where,
                step < automatic ? fmt::format("ask for longer steps: up to {:.3g} s are stable", bound)
                                 : how_to_lengthen_steps(*body_, *simulation_, frequency_, tools));
}

}  // namespace palpate
