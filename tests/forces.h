#pragma once
#include "palpate/body/body.h"

#include <vector>

/// The springs' forces on every node in double, straight from 2005's eq. 1 (without its factor 1/2): an
/// implementation of its own, for tests to hold node.inl against.
inline std::vector<palpate::dvec3> spring_forces(const palpate::Body& body,
                                                 const std::vector<palpate::dvec3>& p) {
    using namespace palpate;
    const std::vector<int> ends = neighbours(body);
    const std::size_t links = body.springs.links.size();
    std::vector<dvec3> forces(body.count(), dvec3(0));
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < links; ++l) {
            const int j = ends[i * links + l];
            if (j < 0) continue;
            const Link& link = body.springs.links[l];
            const double k = link.stiffness * body.springs.quarters(i, l) / 4.0;
            const double length = glm::distance(p[i], p[j]);
            forces[i] += k * (length - link.rest) / length * (p[j] - p[i]);
        }
    return forces;
}
