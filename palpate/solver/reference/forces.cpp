#include "palpate/solver/forces.h"

#include "palpate/base/error.h"
#include "palpate/base/parallel.h"
#include "palpate/solver/reference/node.h"

#include <fmt/format.h>

namespace palpate {

using Now = reference::NodesNow<double>;
using Physics = reference::NodePhysics<double>;

struct Forces::Inside {
    const Body body;
    const reference::Surroundings around{body};
    const Pass pass = make_pass(body, {});
    const std::vector<dvec3> none = std::vector<dvec3>(body.count(), dvec3(0));  // velocities

    void require(std::initializer_list<std::size_t> lengths) const {
        for (std::size_t length : lengths)
            if (length != body.count())
                throw Error(fmt::format("a list of {} for {} nodes", length, body.count()),
                            name_in_errors(body), "hand in one for each");
    }

    Physics physics(const Now& now, std::size_t node, std::span<const Physics::Eight> cells = {}) const {
        return reference::see(around, pass, now, node, {}, cells);
    }

    // of_cell(c) of each cell of tissue, then of_node(physics) of each node into `into`: on all processors.
    template <class OfCell, class OfNode>
    void of_all(const Now& now, std::span<dvec3> into, OfCell of_cell, OfNode of_node) const {
        std::vector<Physics::Eight> cells(around.tissue ? body.cells.size() : 0);
        parallel_for(cells.size(), 1024, [&](std::size_t c) { cells[c] = of_cell(c); });
        parallel_for(into.size(), 4096, [&](std::size_t i) {
            Physics nodes = physics(now, i, cells);
            into[i] = of_node(nodes, reference::load(around, now, i));
            if (around.tissue) into[i] += nodes.cells_force();
        });
    }
};

Forces::Forces(const Body& body) : in_((check(body), new Inside{body})) {}
Forces::~Forces() = default;

void Forces::at(std::span<const dvec3> positions, std::span<dvec3> forces) const {
    in_->require({positions.size(), forces.size()});
    const Now now(positions.data(), in_->none.data());
    in_->of_all(
        now, forces, [&](std::size_t c) { return reference::cell_pushes(in_->around, in_->pass, now, c); },
        [](Physics& physics, const Physics::Node& node) { return physics.elastic_force(node.position); });
}

void Forces::stiffness_times(std::span<const dvec3> positions, std::span<const dvec3> displacement,
                             std::span<dvec3> forces) const {
    in_->require({positions.size(), displacement.size(), forces.size()});
    const Now now(positions.data(), displacement.data());
    in_->of_all(
        now, forces,
        [&](std::size_t c) {
            const auto lowest = std::size_t(in_->body.cells[c][0]);
            Physics physics = in_->physics(now, lowest);
            return physics.on_corners(physics.cell_stiffness_times(
                physics.cell_corners(0), physics.cell_velocities(0), physics.cell_weight(0)));
        },
        [](Physics& physics, const Physics::Node& node) { return physics.elastic_stiffness_times(node); });
}

double Forces::energy(std::span<const dvec3> positions) const {
    in_->require({positions.size()});
    const Now now(positions.data(), in_->none.data());
    double sum = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
        sum += in_->physics(now, i).elastic_energy(positions[i]);
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
