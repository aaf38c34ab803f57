#pragma once
#include "palpate/body/body.h"
#include "palpate/body/feel.h"
#include "palpate/body/simulation.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/safety.h"

#include <optional>
#include <span>
#include <vector>

// A hand that feels a simulated body and presses it, against the same press at rest and against theory: tests
// hold what is quick to bounds, palpate-tables prints all of it for docs/results.md. All of it runs in
// simulated time, without gravity.

namespace palpate::studies {

/// A ball of harder tissue in a block.
struct Nodule {
    double depth;                    // m, of its uppermost point below the top of the block,
    double radius = 0.005;           // m, in whose middle it lies
    double youngs_modulus = 30'000;  // Pa
};

/// A block of tissue that stands on its bottom, and the ball with which a hand presses it from above.
struct FeltBlock {
    dvec3 size = {0.06, 0.036, 0.06};  // m
    double spacing = 0.006;            // m
    double youngs_modulus = 4000;      // Pa
    double damping = 10;               // 1/s, of velocities
    double radius = 0.012;             // m, of the ball
    double stiffness = Feel{}.stiffness;
    double most_damping = SafetySettings{}.most_damping;  // N·s/m, that the passivity observer may add
    std::optional<Nodule> nodule = {};
};

/// How long the slices of the world are, and how often the hand's loop ticks.
struct FeltClock {
    double slice = slice_seconds;  // s
    double rate = 1000;            // Hz
    /// s: in which the body gets back, as a force on the place that was touched last, what the safety limits
    /// took of a load from the hand; 0: never, as in scenes.
    double gives_back_in = 0;
};

/// The force on a ball at each depth in turn, N, when the block has come to rest; on the reference in double.
std::vector<double> pressed_at_rest(const FeltBlock& block, std::span<const double> depths);

/// What a hand feels there that follows a script, N: the mean over the last half of a second.
double felt_at_rest(const FeltBlock& block, double depth, const FeltClock& clock);

/// The force on a hand that swings up and down, against the force at rest at each of the depths that it
/// passes: their fundamentals.
struct FeltSwing {
    double amplitude;  // over that of the force at rest
    double ahead;      // degrees, of the force at rest
};
std::vector<FeltSwing> felt_swings(const FeltBlock& block, double frequency,
                                   std::span<const FeltClock> clocks);

/// The force on a hand that strokes a block, along x, from a quarter of its length to three quarters.
struct FeltStroke {
    std::vector<double> places, forces;  // m, from the middle; N, upwards
};
FeltStroke felt_stroke(const FeltBlock& block, double depth, const FeltClock& clock = {});

/// The block that hands stroke in search of a nodule.
inline const FeltBlock palpated{
    .size = {0.072, 0.036, 0.048}, .spacing = 0.003, .youngs_modulus = 3000, .damping = 20, .radius = 0.008};

/// How much more a hand feels over a nodule than in the same place without it, at most, N.
double excess(const FeltStroke& with, const FeltStroke& without);

/// The hand of an arm that presses a block, and how stiff the touch may be before its force begins to swing.
struct FeltHold {
    double youngs_modulus;     // Pa, of the block
    double slice;              // s, of the world
    double most_damping = 0;   // N·s/m, as above; there are no other safety limits
    double gives_back_in = 0;  // s, as of a FeltClock
    VirtualHandSettings hand = {.delay = 0.001};
};

/// Whether the force swings less than in the second after the equilibrium of the hand, 4 mm deep, jumped by
/// 0.2 mm, five seconds later.
bool comes_to_rest(const FeltHold& hold, double stiffness);

struct StiffestTouch {
    double measured;  // N/m, by bisection to two percent; `most` if it is stable at that
    double linear;    // N/m, as the linear system says that sees the block's slope at rest
    static constexpr double most = 20'000;
};
StiffestTouch stiffest_touch(const FeltHold& hold);

/// How stiff a touch of a rigid block may be in the linear system, N/m; and as Colgate and Schenkel say. A
/// load is the mean of a slice, which the hand feels during the next one: half a slice, a tick and the
/// device's own delay before it is held.
double stiffest_linear(const FeltHold& hold);
double stiffest_passive(const FeltHold& hold);

/// What a hand and a free block have given each other in the first second of their contact, N s.
struct GivenAndFelt {
    double given, felt;
};
GivenAndFelt momentum_of_a_free_block(const FeltClock& clock,
                                      double most_damping = SafetySettings{}.most_damping);

}  // namespace palpate::studies
