#include "palpate/body/body.h"

#include "palpate/body/grid.h"

#include <cmath>

namespace palpate {

Table table(const Body& body) {
    if (const auto* written = std::get_if<Table>(&body.springs)) return *written;
    const Stencil& stencil = body.stencil();
    const GridIndex node_at(stencil.at);
    Table table{int(stencil.links.size()), {}};
    table.ties.reserve(body.count() * stencil.links.size());
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l) {
            const Link& link = stencil.links[l];
            const int quarters = stencil.quarters(i, l);
            const int to = quarters > 0 ? node_at.at(stencil.at[i] + link.offset) : -1;
            const float strength =
                stencil.strength.empty() || to < 0 ? 1 : 0.5f * (stencil.strength[i] + stencil.strength[to]);
            table.ties.push_back({to, 0.25f * float(quarters), strength * link.stiffness, link.rest});
        }
    return table;
}

std::vector<uvec2> spring_ends(const Body& body) {
    std::vector<uvec2> ends;
    const Table springs = table(body);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i))
            if (tie.to > int(i) && tie.share > 0 && tie.stiffness > 0) ends.push_back({i, tie.to});
    return ends;
}

std::vector<ivec3> cell_places(const Body& body) {
    std::vector<ivec3> places;
    for (const auto& nodes : body.cells) places.push_back(body.stencil().at[nodes[0]]);
    return places;
}

double mass(const Body& body) {
    double sum = 0;
    for (float inverse : body.inverse_mass)
        if (inverse > 0) sum += 1.0 / inverse;
    return sum;
}

std::size_t inverted_cells(const Body& body, std::span<const vec3> positions) {
    std::size_t inverted = 0;
    for (const auto& nodes : body.cells) {
        // The mean edges along the three axes span a box of the cell's volume, nearly.
        vec3 edges[3] = {vec3(0), vec3(0), vec3(0)};
        for (int corner = 0; corner < 8; ++corner)
            for (int axis = 0; axis < 3; ++axis)
                edges[axis] += (corner >> axis & 1 ? 1.0f : -1.0f) * positions[nodes[corner]];
        inverted += !(glm::dot(glm::cross(edges[0], edges[1]), edges[2]) > 0);
    }
    return inverted;
}

Energy energy(const Body& body, const State& state) {
    Energy sum;
    const Table springs = table(body);
    for (std::size_t i = 0; i < body.count(); ++i) {
        const dvec3 v = state.velocities[i];
        if (body.inverse_mass[i] > 0) sum.kinetic += 0.5 * glm::dot(v, v) / body.inverse_mass[i];
        for (const Tie& tie : springs.of(i)) {
            if (tie.to < int(i)) continue;  // each spring once; -1 is no spring
            const double stretch = glm::distance(state.positions[i], state.positions[tie.to]) - tie.rest;
            sum.elastic += 0.5 * tie.share * tie.stiffness * stretch * stretch;
        }
    }
    return sum;
}

}  // namespace palpate
