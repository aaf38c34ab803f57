#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// A round tip that presses on a body during one call of Solver::step. It pushes every node inside it outward
/// with a pressure of stiffness / (π radius²) for each metre of depth, each node standing for an area of one
/// spacing squared; so a tip that sinks in whole meets `stiffness` newtons a metre, however fine the lattice
/// is.
struct Press {
    vec3 centre = vec3(0);    // m, at the start of the call
    vec3 velocity = vec3(0);  // m/s; the tip moves on at this speed during the call
    float radius = 0.01f;     // m
    float stiffness = 400;    // N/m
};

/// The spring between the tip and one node of a lattice, N/m: what a press adds to the stability bound.
inline float contact_stiffness(const Press& press, float spacing) {
    return press.stiffness * spacing * spacing / (3.14159265f * press.radius * press.radius);
}

}  // namespace palpate
