#pragma once
#include "palpate/body/body.h"

#include <vector>

/// The springs' forces on every node in double, straight from 2005's eq. 1 (without its factor 1/2): an
/// implementation of its own, for tests to hold node.inl against.
inline std::vector<palpate::dvec3> spring_forces(const palpate::Body& body,
                                                 const std::vector<palpate::dvec3>& p) {
    using namespace palpate;
    const Table springs = table(body);
    std::vector<dvec3> forces(body.count(), dvec3(0));
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i)) {
            if (tie.to < 0) continue;
            const dvec3 along = p[std::size_t(tie.to)] - p[i];
            const double k = double(tie.share) * tie.stiffness, length = glm::length(along);
            forces[i] += k * (length - tie.rest) / length * along;
        }
    return forces;
}
