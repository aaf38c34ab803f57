#include "palpate/touch/devices/damped_spring.h"

#include <cmath>

namespace palpate {

Swing after(const Swing& from, const DampedSpring& spring, double time) {
    const double half = spring.damping / 2, square = half * half - spring.stiffness;
    // With r² = square: even = exp(-half t) cosh(r t), odd = exp(-half t) sinh(r t) / r; with cosine and sine
    // where square is negative. Written so that nothing overflows or cancels, however stiff, damped or nearly
    // critically damped it is.
    double even, odd;
    if (square > 0) {
        const double r = std::sqrt(square);
        const double slow = std::exp(-spring.stiffness / (half + r) * time);
        const double gone = -std::expm1(-2 * r * time);  // 1 minus the ratio of the faster exponential to the
                                                         // slower
        even = slow * (1 - gone / 2);
        odd = slow * gone / (2 * r);
    } else {
        const double turn = std::sqrt(-square) * time, decay = std::exp(-half * time);
        even = decay * std::cos(turn);
        odd = decay * (turn > 0 ? std::sin(turn) / turn : 1) * time;
    }
    return {(even + half * odd) * from.offset + odd * from.velocity,
            -spring.stiffness * odd * from.offset + (even - half * odd) * from.velocity};
}

}  // namespace palpate
