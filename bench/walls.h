#pragma once
#include "palpate/body/feel.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/touch.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace palpate::studies {

/// A hand that is pressed against a flat wall, and the haptic loop between the two.
struct Wall {
    double damping = Feel{}.damping;  // N·s/m, of the wall
    double rate = 1000;               // Hz
    // A desktop device: its encoder's resolution, and a round trip of a millisecond.
    VirtualHandSettings hand = {.resolution = 3e-5, .delay = 0.001};
};

/// The stiffest wall on which a Touch comes to rest after a disturbance, N/m, by bisection to half a percent;
/// 0 if it rests on none. The passivity observer may add damping up to `most_damping`, N·s/m.
double stiffest_measured(const Wall& wall, double most_damping = 0);

/// The same for the linear sampled-data system without the encoder: where an eigenvalue leaves the unit
/// circle.
double stiffest_linear(const Wall& wall);

/// The stiffest wall that is passive, whoever holds the device: hand damping ≥ K (T/2 + delay) + b, T being
/// a tick (Colgate and Schenkel 1997; a delay of the force costs K · delay). 0 if none is.
double stiffest_passive(const Wall& wall);

// What other studies of hands share.

/// The largest stiffness up to which a condition holds, N/m, by doubling and bisection to a fraction; 0 if it
/// does not hold at 1 N/m, and none above `most`.
double stiffest(double fraction, double most, const std::function<bool(double)>& holds);

/// The settings of a touch without the safety limits, but for the passivity observer, if any.
TouchSettings without_limits(const Feel& feel, double most_damping = 0);

struct Range {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    void take(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    double size() const { return most - least; }
};

}  // namespace palpate::studies
