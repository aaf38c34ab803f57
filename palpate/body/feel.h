#pragma once
#include <limits>

namespace palpate {

/// How hard a surface is to slide on: the largest force along it is so many times that against it.
struct Friction {
    double still = 0.3;    // while the tip sticks
    double sliding = 0.2;  // while it slips; not more than that

    bool operator==(const Friction&) const = default;
};

/// How a surface feels, and what a touch leaves on it.
struct Feel {
    double stiffness = 400;  // N/m; where a device cannot do so much, half of what it can, see DeviceSpec
    double damping = 1;      // N·s/m, against going in and out; it never pulls
    Friction friction = {};
    double dent_width = 0.01;  // m, the standard deviation of the dent under a tip (2007, section IV-A)
    double yield = std::numeric_limits<double>::infinity();  // m: a dent springs back by no more than that;
                                                             // the rest stays, and is felt

    bool operator==(const Feel&) const = default;
};

}  // namespace palpate
