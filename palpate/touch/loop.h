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
    double rate = 1000;    // Hz, from 250 to 4000; a device that paces has its own
    double spin = 100e-6;  // s: the last part of each wait, during which it does not sleep; up to 1 ms
};

/// How a loop has kept time.
struct LoopTiming {
    Durations periods;                           // from tick to tick, s of the clock
    Durations work;                              // of a tick, s of the processor's time on this thread
    Durations proxy;                             // of the proxy alone, likewise; one for each touch
    std::atomic<std::uint64_t> missed = 0;       // ticks that were left out because their time had gone by
    std::atomic<std::uint64_t> longest_run = 0;  // of those, one after the other
};

/// Ticks touches on a thread of its own, a thousand times a second by absolute deadlines, with whatever
/// priority the system grants; a Watchdog lets go of them if it gets stuck. Both end with this object, and
/// the devices are stopped. The touches must outlive it.
class TouchLoop {
 public:
    /// Throws Error if the rate or the spin is out of bounds, or if one of the touches is not there.
    explicit TouchLoop(std::vector<Touch*> touches, LoopSettings settings = {});
    ~TouchLoop();
    TouchLoop(const TouchLoop&) = delete;
    TouchLoop& operator=(const TouchLoop&) = delete;

    const LoopTiming& timing() const { return timing_; }

    /// What the system granted to the thread.
    Granted granted() const;

    double rate() const { return settings_.rate; }

    /// How often the watchdog had to act.
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
    Watchdog watchdog_;  // before there is anything to watch, and after
    std::thread loop_;
};

}  // namespace palpate
