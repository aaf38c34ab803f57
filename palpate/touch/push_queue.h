#pragma once
#include "palpate/base/ring_buffer.h"
#include "palpate/base/vectors.h"

#include <vector>

namespace palpate {

/// What a hand gave to a surface.
struct Push {
    int surface = 0;           // the number of its Touchable,
    int triangle = 0;          // which of its triangles,
    dvec3 weights = dvec3(0);  // and where in that: barycentric
    dvec3 impulse = dvec3(0);  // N·s: the opposite of what the hand was given
    double time = 0;           // s, on the loop's clock, when it ended
};

/// The pushes of a touch on their way to a simulation. One that finds no room waits and takes those that
/// follow on its surface into it, at the newest place: late, but no momentum is lost. It allocates only when
/// it is made, and neither side ever waits.
class PushQueue {
 public:
    explicit PushQueue(std::size_t surfaces) : waiting_(surfaces) {}

    // The loop's:
    void add(const Push& push) noexcept;
    /// What waits, as far as there is room now.
    void send() noexcept;

    /// The simulation's: the next, in their order on each surface; false if there is none.
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
