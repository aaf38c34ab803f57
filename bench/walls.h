#pragma once
#include "palpate/body/feel.h"
#include "palpate/touch/devices/virtual_hand.h"

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

}  // namespace palpate::studies
