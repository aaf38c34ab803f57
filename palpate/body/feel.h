#pragma once
#include <limits>

namespace palpate {

/// The coefficients of friction (Coulomb): the largest tangential force over the normal force.
struct Friction {
    double still = 0.3;    // static: while the tip sticks
    double sliding = 0.2;  // kinetic: while it slips; not more than `still`

    bool operator==(const Friction&) const = default;
};

/// How a surface feels, and how it is dented for good.
struct Feel {
    double stiffness = 400;  // N/m, of the penalty force; at most half of what the device can render, see
                             // DeviceSpec
    double damping = 1;      // N·s/m, along the normal; it never pulls
    Friction friction = {};
    double dent_width = 0.01;  // m, the standard deviation of the dent under a tip (2007, section IV-A)
    double yield = std::numeric_limits<double>::infinity();  // m: the depth up to which a dent is elastic;
                                                             // deeper ones last (plastic), and can be felt

    bool operator==(const Feel&) const = default;
};

}  // namespace palpate
