#pragma once
#include "palpate/body/feel.h"
#include "palpate/touch/devices/virtual_hand.h"

namespace palpate::studies {

/// A hand that is pressed against a flat wall, and the loop between the two.
struct Wall {
    double damping = Feel{}.damping;  // N·s/m, of the wall
    double rate = 1000;               // Hz
    // A desktop device: what an encoder tells apart, and a millisecond for the way there and back.
    VirtualHandSettings hand = {.resolution = 3e-5, .delay = 0.001};
};

/// The stiffest wall on which a Touch comes to rest after it was shaken, N/m, by bisection to half a percent;
/// 0: none, however soft. With the passivity observer adding damping up to `most_damping`, N·s/m, if any.
double stiffest_measured(const Wall& wall, double most_damping = 0);

/// The same of the linear sampled system, without the encoder: until an eigenvalue leaves the unit circle.
double stiffest_linear(const Wall& wall);

/// Up to here the wall is passive, whoever holds the device: hand damping ≥ K (T/2 + delay) + b, T being a
/// tick (Colgate and Schenkel 1997; each force that comes later by `delay` costs K · delay). 0: never.
double stiffest_passive(const Wall& wall);

}  // namespace palpate::studies
