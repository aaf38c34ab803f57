#pragma once
#include <string>

namespace palpate {

/// What the system has granted to a thread that has to keep time.
struct Granted {
    std::string schedule;        // "FIFO 80", "nice -11", "as any other thread"
    bool memory_locked = false;  // none of the process's memory is ever taken away to a disk
    bool wakes_exactly = false;  // timers are not put off to save power
};

/// Asks that the calling thread run before others, and if `first` even before those that asked for that: as a
/// real-time thread of the highest priority that is allowed; else with as much of niceness as is; else it
/// stays as it is. Memory is locked only where no limit is set on that, because with one a later allocation
/// would fail.
Granted keep_time(bool first = false);

/// The kernel's name, version and kind of preemption, in a line.
std::string kernel();

/// Seconds of the processor's time that the calling thread has had.
double thread_seconds();

/// Sleeps until `now()` is at least that.
void sleep_until(double time);

}  // namespace palpate
