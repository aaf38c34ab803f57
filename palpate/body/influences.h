#pragma once
#include "palpate/base/vectors.h"
#include "palpate/body/collider.h"
#include "palpate/body/feel.h"

#include <cstddef>
#include <span>

namespace palpate {

/// A spherical tip that presses on a body during one call of Solver::step, by penalty forces. Where it
/// reaches below the surface, it pushes radially with a pressure of stiffness / (π radius²) for each metre of
/// depth. So a tip whose whole cross section is d metres deep is pushed back with stiffness · d newtons,
/// however fine the lattice is. Where it presses, a damper takes up motion along its radius, and Coulomb
/// friction motion across: a node that sticks goes with the tip, until what pulls at it is more than
/// friction.still times the force that presses it; then it slips, and friction.sliding times that force pulls
/// at it. Skin on metal and plastics has 0.52 and 0.36 (medians of 450 measurements, Veijgen, Masen and van
/// der Heide 2013), wet tissue on steel about 0.1.
struct Press {
    vec3 centre = vec3(0);    // m, at the start of the call
    vec3 velocity = vec3(0);  // m/s; the tip moves with it during the call
    float radius = 0.01f;     // m
    float stiffness = 400;    // N/m
    Friction friction = {0, 0};
    float damping = 0;  // N·s/m, of a tip that is in with its whole cross section; it never pulls
};

/// Where it is so many seconds later.
inline Press after(Press press, float seconds) {
    press.centre += seconds * press.velocity;
    return press;
}

inline float cross_section(const Press& press) { return 3.14159265f * press.radius * press.radius; }  // m²

/// The pressure of a tip for each metre of depth, Pa/m.
inline float pressure_per_metre(const Press& press) { return press.stiffness / cross_section(press); }

/// Whether a tip resists what moves past it.
inline bool resists(const Press& press) { return press.friction.still > 0 || press.damping > 0; }

/// An external action on one node: a force, and a spring of rest length 0 to a moving point, such as a mouse
/// that drags it. Any number of them may act on a node.
struct NodePush {
    int node = 0;
    vec3 to = vec3(0);        // m, at the start of the call: the point to which the spring pulls
    vec3 velocity = vec3(0);  // m/s, of that point
    float stiffness = 0;      // N/m, of the spring
    vec3 force = vec3(0);     // N
};

/// Prescribed motion (a Dirichlet boundary condition): nodes of inverse mass 0 that move evenly to these
/// places until the end of the call, whatever forces act on them. A node of inverse mass 0 without a Move
/// stays.
struct Move {
    std::span<const int> nodes;
    std::span<const vec3> to;  // m, one for each node
};

/// All external actions on a body during one call of Solver::step, besides gravity. Solver::step says what it
/// refuses.
struct Influences {
    std::span<const Press> presses = {};
    std::span<const NodePush> pushes = {};
    std::span<const Move> moves = {};
    std::span<const Motion> colliders =
        {};               // one for each of Simulation::colliders; or none: all stand still
    vec3 wind = vec3(0);  // m/s; it acts if Simulation::air is above 0
    double arrival = 0;   // s, in which moves reach their places; 0: by the end of the call
};

}  // namespace palpate
