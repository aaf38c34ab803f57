#pragma once
#include "palpate/base/vectors.h"

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

}  // namespace palpate
