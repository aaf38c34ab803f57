#include "palpate/solver/short_steps.h"

#include "palpate/solver/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace palpate {
namespace {

constexpr double uneven = 4;      // times the median: beyond that a node or a spring is the odd one
constexpr double worth_it = 1.5;  // times as long: less is not what shortens steps

// All that a step's length depends on.
struct Causes {
    Integrator integrator;
    double frequency;              // rad/s, of the body alone
    double damping, link_damping;  // 1/s, s
    ToolStiffness tools;
};

double step_of(const Body& body, const Causes& causes) {
    const double touched = touched_frequency(body, causes.frequency, causes.tools.contact, causes.tools.pull);
    return automatic_step(causes.integrator, touched, causes.damping, causes.link_damping,
                          frequency_reserve(body));
}

template <class T>
T median(std::vector<T> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The same body with no node much lighter than most; and how many were.
std::pair<Body, std::size_t> without_light_nodes(Body body) {
    std::vector<float> free;
    for (float inverse : body.inverse_mass)
        if (inverse > 0) free.push_back(inverse);
    const float most = float(uneven) * median(free);
    for (float& inverse : body.inverse_mass) inverse = std::min(inverse, most);
    return {std::move(body), std::size_t(std::ranges::count_if(free, [&](float one) { return one > most; }))};
}

TissueCells* tissue_in(Body& body) {
    for (Term& term : body.terms)
        if (auto* cells = std::get_if<TissueCells>(&term)) return cells;
    return nullptr;
}

// The same body with no spring or cell much stiffer than most.
Body without_stiff_parts(Body body) {
    if (TissueCells* cells = tissue_in(body)) {
        const float most = float(uneven) * median(cells->weights);
        for (float& weight : cells->weights) weight = std::min(weight, most);
        for (Term& term : body.terms)
            if (auto* listed = std::get_if<ListedSprings>(&term)) listed->springs.clear();
        return body;
    }
    body = without_grid(std::move(body));
    std::vector<Spring>& springs = std::get<ListedSprings>(body.terms[0]).springs;
    std::vector<float> all;
    for (const Spring& spring : springs)
        if (spring.stiffness > 0) all.push_back(spring.stiffness);
    const float most = float(uneven) * median(all);
    for (Spring& spring : springs) spring.stiffness = std::min(spring.stiffness, most);
    return body;
}

// The same body with no hinges.
Body without_bending(Body body) {
    std::erase_if(body.terms, [](const Term& term) { return std::holds_alternative<Bending>(term); });
    return body;
}

struct Candidate {
    std::string remedy;
    std::function<void(Causes&)> leave_out;
};

std::vector<Candidate> candidates(const Body& body, const Causes& causes) {
    std::vector<Candidate> all;
    auto at_most = [](double frequency) {
        return [frequency](Causes& c) { c.frequency = std::min(c.frequency, frequency); };
    };
    if (body.link_damping > 0)
        all.push_back({fmt::format("lower link_damping = {:.3g} s", body.link_damping),
                       [](Causes& c) { c.link_damping = 0; }});
    if (body.damping > 0)
        all.push_back(
            {fmt::format("lower damping = {:.3g} 1/s", body.damping), [](Causes& c) { c.damping = 0; }});
    if (causes.tools.contact > 0)
        all.push_back({"use softer or wider tools that press", [](Causes& c) { c.tools.contact = 0; }});
    if (causes.tools.pull > 0)
        all.push_back({"use softer tools that drag", [](Causes& c) { c.tools.pull = 0; }});
    if (causes.integrator != Integrator::verlet)
        all.push_back({"choose verlet", [](Causes& c) { c.integrator = Integrator::verlet; }});
    if (const auto [even, light] = without_light_nodes(body); light > 0)
        all.push_back(
            {fmt::format("make its nodes weigh more alike ({} of {} weigh less than a quarter of the "
                         "median; of a sheet, weld or simplify the surface)",
                         light, body.count()),
             at_most(highest_frequency(even))});
    if (const Body limp = without_bending(body); limp.terms.size() < body.terms.size())
        all.push_back({"lower its bending or make its triangles larger", at_most(highest_frequency(limp))});
    all.push_back({"make its stiffest springs or regions softer",
                   at_most(highest_frequency(without_stiff_parts(body)))});
    if (Body usual = body; TissueCells* cells = tissue_in(usual)) {
        cells->poisson = std::min(cells->poisson, 0.45f);
        all.push_back({"use a Poisson's ratio of 0.45", at_most(highest_frequency(usual))});
    }
    return all;
}

}  // namespace

std::string how_to_lengthen_steps(const Body& body, const Simulation& simulation, double frequency,
                                  const ToolStiffness& tools) {
    const double wanted = simulation.shortest_step;
    Causes causes{simulation.integrator, frequency, body.damping, body.link_damping, tools};
    std::vector<Candidate> left = candidates(body, causes);
    double step = step_of(body, causes);
    std::string advice;
    while (step < wanted) {
        const Candidate* best = nullptr;
        double longest = worth_it * step;
        for (const Candidate& one : left) {
            Causes without = causes;
            one.leave_out(without);
            if (const double longer = step_of(body, without); longer > longest) {
                longest = longer;
                best = &one;
            }
        }
        if (!best) break;
        best->leave_out(causes);
        step = longest;
        advice += fmt::format("{}{}: without that {:.0f} steps would do", advice.empty() ? "" : "; and ",
                              best->remedy, std::ceil(frame_seconds / step));
        left.erase(left.begin() + (best - left.data()));
    }
    if (step < wanted)
        advice += std::string(advice.empty() ? "" : "; and ") +
                  "use a softer material, a larger spacing or a heavier body, and check its units";
    return advice;
}

}  // namespace palpate
