#pragma once
#include "palpate/base/ring_buffer.h"
#include "palpate/base/vectors.h"

#include <vector>

namespace palpate {

/// The impulse that a hand gave to a surface.
struct Push {
    int surface = 0;           // the number of its Touchable,
    int triangle = 0;          // which of its triangles,
    dvec3 weights = dvec3(0);  // and where in that: barycentric
    dvec3 impulse = dvec3(0);  // N·s: the reaction to the force on the hand
    double time = 0;           // s, on the loop's clock, when it ended
};

/// A lock-free queue of pushes, from a haptic loop to a simulation. When it is full, pushes wait, and those
/// on one surface are summed at the newest place: they arrive late, but no momentum is lost. Memory is
/// allocated only in the constructor, and neither side ever waits.
class PushQueue {
 public:
    explicit PushQueue(std::size_t surfaces) : waiting_(surfaces) {}

    // For the loop:
    void add(const Push& push) noexcept;
    /// Sends what waits, as far as there is room now.
    void send() noexcept;

    /// For the simulation: the next push, in order for each surface; false if there is none.
    bool next(Push& push) noexcept { return ring_.take(push); }

 private:
    struct Waiting {
        Push sum;
        bool any = false;
    };
    std::vector<Waiting> waiting_;  // one a surface
    RingBuffer<Push, 256> ring_;
};

}  // namespace palpate
