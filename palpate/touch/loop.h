#pragma once
#include "palpate/base/realtime.h"
#include "palpate/touch/timing.h"
#include "palpate/touch/watchdog.h"

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace palpate {

struct LoopSettings {
    double rate = 1000;    // Hz, from 250 to 4000; a device that paces the loop has its own
    double spin = 100e-6;  // s: the last part of each wait, in which it spins instead of sleeping; up to 1 ms
};

/// The timing of a loop.
struct LoopTiming {
    Durations periods;                           // from tick to tick, s of wall-clock time
    Durations work;                              // of a tick, s of processor time of this thread
    Durations proxy;                             // of the proxy alone, likewise; one for each touch
    std::atomic<std::uint64_t> missed = 0;       // ticks that were skipped because they were overdue
    std::atomic<std::uint64_t> longest_run = 0;  // the most of those in a row
};

/// The servo loop: ticks touches on a thread of its own, a thousand times a second by absolute deadlines,
/// with real-time priority if the system grants it. A Watchdog stops their devices if it stalls. When this
/// object ends, both threads end and the devices are stopped. The touches must outlive it.
class TouchLoop {
 public:
    /// Throws Error if the rate or the spin is out of range, or if one of the touches is null.
    explicit TouchLoop(std::vector<Touch*> touches, LoopSettings settings = {});
    ~TouchLoop();
    TouchLoop(const TouchLoop&) = delete;
    TouchLoop& operator=(const TouchLoop&) = delete;

    const LoopTiming& timing() const { return timing_; }

    /// The priority that the system granted to the thread.
    Granted granted() const;

    double rate() const { return settings_.rate; }

    /// How often the watchdog has intervened.
    std::uint64_t times_stalled() const { return watchdog_.times_stalled(); }

 private:
    void run();
    bool tick(double now);
    void wait_for(double time) const;

    const std::vector<Touch*> touches_;
    const LoopSettings settings_;
    bool paced_ = false;
    LoopTiming timing_;
    Granted granted_;
    std::atomic<bool> started_ = false, ends_ = false;
    Watchdog watchdog_;  // declared before the thread, so that it also outlives it
    std::thread loop_;
};

}  // namespace palpate
