#pragma once
#include "palpate/body/body.h"
#include "palpate/body/influences.h"

#include <span>
#include <vector>

namespace palpate {

/// A node of a body's outside that a tip presses.
struct PressedNode {
    int node = 0;
    double pressure = 0;  // Pa
    double area = 0;      // m², of the outside that it stands for
};

/// What a tip does to a body at one moment.
struct ContactForce {
    dvec3 force = dvec3(0);   // N, on the body
    dvec3 normal = dvec3(0);  // unit: the mean direction of the pressure, into the body; 0 without contact
    dvec3 place = dvec3(0);   // m, the centre of pressure, on the surface; 0 without contact
    double penetration = 0;   // m, of the tip into the surface, where it is deepest
    std::vector<PressedNode> pressed;

    double area() const;      // m², of all pressed nodes
    double pressure() const;  // Pa, the largest
};

/// The force of a tip by the law of every step (tip_force in node.inl), in double. `nodes`: where they are
/// now. `press`: the tip where it is now, whatever its velocity. Throws Error if it is not finite, or has no
/// radius, or if there is not one node for each of the body's, at a place that is finite.
ContactForce contact_force(const Body& body, std::span<const vec3> nodes, const Press& press);

}  // namespace palpate
