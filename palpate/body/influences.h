#pragma once
#include "palpate/base/vectors.h"
#include "palpate/body/collider.h"

#include <cstddef>
#include <span>

namespace palpate {

/// A round tip that presses on a body during one call of Solver::step. Where it reaches below the surface, it
/// pushes straight out of its centre with a pressure of stiffness / (π radius²) for each metre of depth: a
/// tip whose whole cross section is d metres deep is pushed back with stiffness · d newtons, however fine the
/// lattice is.
struct Press {
    vec3 centre = vec3(0);    // m, at the start of the call
    vec3 velocity = vec3(0);  // m/s; the tip moves on at this speed during the call
    float radius = 0.01f;     // m
    float stiffness = 400;    // N/m
};

/// The pressure of a tip for each metre of depth, Pa/m.
inline float pressure_per_metre(const Press& press) {
    return press.stiffness / (3.14159265f * press.radius * press.radius);
}

/// What somebody does to one node: a force, and a spring of no length that draws it towards a moving point,
/// as a mouse or a hand does that drags it. Any number of them may act on a node.
struct NodePush {
    int node = 0;
    vec3 to = vec3(0);        // m, at the start of the call: where the spring draws it
    vec3 velocity = vec3(0);  // m/s, of that point
    float stiffness = 0;      // N/m, of the spring
    vec3 force = vec3(0);     // N
};

/// Prescribed motion: nodes of inverse mass 0 that go evenly to these places by the end of the call, whatever
/// pulls at them. A node of inverse mass 0 that no Move names stays.
struct Move {
    std::span<const int> nodes;
    std::span<const vec3> to;  // m, one a node
};

/// What acts on a body from outside during one call of Solver::step, besides gravity. Solver::step says what
/// it refuses.
struct Influences {
    std::span<const Press> presses = {};
    std::span<const NodePush> pushes = {};
    std::span<const Move> moves = {};
    std::span<const Motion> colliders =
        {};               // one for each of Simulation::colliders; or none, and all stand still
    vec3 wind = vec3(0);  // m/s; felt where Simulation::air is above 0
    double arrival = 0;   // s, in which moves lead to their places; 0: by the end of the call
};

}  // namespace palpate
