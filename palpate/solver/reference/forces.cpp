#include "palpate/solver/forces.h"

#include "palpate/base/error.h"
#include "palpate/solver/reference/node.h"

#include <fmt/format.h>

namespace palpate {

using reference::NodeStates;

struct Forces::Inside {
    const Body body;
    const reference::Surroundings around{body};
    const Pass pass = make_pass(body, {});

    void require(std::size_t length) const {
        if (length == body.count()) return;
        throw Error(fmt::format("a list of {} for {} nodes", length, body.count()), name_in_errors(body),
                    "hand in one for each");
    }

    NodeStates<double> states(std::span<const dvec3> positions, std::span<const dvec3> velocities) const {
        require(positions.size());
        NodeStates<double> states{{positions.begin(), positions.end()},
                                  {velocities.begin(), velocities.end()}};
        states.velocities.resize(body.count(), dvec3(0));
        return states;
    }
};

Forces::Forces(const Body& body) : in_((check(body), new Inside{body})) {}
Forces::~Forces() = default;

void Forces::at(std::span<const dvec3> positions, std::span<dvec3> forces) const {
    in_->require(forces.size());
    const NodeStates<double> states = in_->states(positions, {});
    for (std::size_t i = 0; i < forces.size(); ++i)
        forces[i] = reference::see(in_->around, in_->pass, states, i).elastic_force(positions[i]);
}

void Forces::stiffness_times(std::span<const dvec3> positions, std::span<const dvec3> displacement,
                             std::span<dvec3> forces) const {
    in_->require(displacement.size());
    in_->require(forces.size());
    const NodeStates<double> states = in_->states(positions, displacement);
    for (std::size_t i = 0; i < forces.size(); ++i)
        forces[i] = reference::see(in_->around, in_->pass, states, i)
                        .elastic_stiffness_times(reference::load(in_->around, states, i));
}

double Forces::energy(std::span<const dvec3> positions) const {
    const NodeStates<double> states = in_->states(positions, {});
    double sum = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
        sum += reference::see(in_->around, in_->pass, states, i).elastic_energy(positions[i]);
    return sum;
}

Energy energy(const Body& body, const State& state) {
    Energy sum{.elastic = Forces(body).energy(state.positions)};
    if (state.velocities.size() != body.count())
        throw Error(fmt::format("{} velocities of {} nodes", state.velocities.size(), body.count()),
                    name_in_errors(body), "hand in one for each");
    for (std::size_t i = 0; i < body.count(); ++i) {
        const dvec3 v = state.velocities[i];
        if (body.inverse_mass[i] > 0) sum.kinetic += 0.5 * glm::dot(v, v) / body.inverse_mass[i];
    }
    return sum;
}

}  // namespace palpate
