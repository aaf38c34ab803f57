#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// A mass on a spring and a damper: x'' + damping x' + stiffness x = 0, x counted from its place of rest.
struct DampedSpring {
    double stiffness;  // 1/s²: k over m; above 0
    double damping;    // 1/s: c over m
};

struct Swing {
    dvec3 offset = dvec3(0);    // m, from the place of rest
    dvec3 velocity = dvec3(0);  // m/s
};

/// Where it is some time later: the equation's solution, so any time is as exact as any other.
Swing after(const Swing& from, const DampedSpring& spring, double time);

}  // namespace palpate
