#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// A damped harmonic oscillator: x'' + damping x' + stiffness x = 0, where x is the offset from rest.
struct DampedSpring {
    double stiffness;  // 1/s²: k over m; above 0
    double damping;    // 1/s: c over m
};

struct Swing {
    dvec3 offset = dvec3(0);    // m, from the place of rest
    dvec3 velocity = dvec3(0);  // m/s
};

/// Its state some time later, by the exact solution: equally exact after any time.
Swing after(const Swing& from, const DampedSpring& spring, double time);

}  // namespace palpate
