#include "palpate/body/body.h"

#include "palpate/body/grid.h"

#include <cmath>

namespace palpate {

std::vector<int> neighbours(const Body& body) {
    const GridIndex node_at(body.springs.at);
    std::vector<int> ends;
    ends.reserve(body.count() * body.springs.links.size());
    for (ivec3 at : body.springs.at)
        for (const Link& link : body.springs.links) ends.push_back(node_at.at(at + link.offset));
    return ends;
}

std::vector<ivec3> cell_places(const Body& body) {
    std::vector<ivec3> places;
    for (const auto& nodes : body.cells) places.push_back(body.springs.at[nodes[0]]);
    return places;
}

std::size_t spring_count(const Body& body) {
    std::size_t ends = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < body.springs.links.size(); ++l) ends += body.springs.quarters(i, l) > 0;
    return ends / 2;
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
    const std::vector<int> ends = neighbours(body);
    const std::vector<Link>& links = body.springs.links;
    for (std::size_t i = 0; i < body.count(); ++i) {
        const dvec3 v = state.velocities[i];
        if (body.inverse_mass[i] > 0) sum.kinetic += 0.5 * glm::dot(v, v) / body.inverse_mass[i];
        for (std::size_t l = 0; l < links.size(); ++l) {
            const int j = ends[i * links.size() + l];
            if (j < int(i)) continue;  // each spring once; -1 is no spring
            const double stretch = glm::distance(state.positions[i], state.positions[j]) - links[l].rest;
            sum.elastic += 0.5 * body.springs.quarters(i, l) / 4.0 * links[l].stiffness * stretch * stretch;
        }
    }
    return sum;
}

}  // namespace palpate
