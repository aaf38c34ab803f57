#pragma once
#include <string>

namespace palpate {

/// What the system has granted to a real-time thread.
struct Granted {
    std::string schedule;        // "FIFO 80", "nice -11", "as any other thread"
    bool memory_locked = false;  // no memory of the process is swapped out
    bool wakes_exactly = false;  // timers have no slack
};

/// Raises the priority of the calling thread: real-time scheduling (SCHED_FIFO) at the highest priority that
/// is allowed, else the lowest niceness that is allowed, else nothing. If `first`, it comes before other
/// threads that called this. Memory is locked only if there is no limit on that, because with a limit a later
/// allocation would fail.
Granted keep_time(bool first = false);

/// The kernel's name, version and preemption model, in one line.
std::string kernel();

/// The processor time that the calling thread has used, s.
double thread_seconds();

/// Sleeps until now() is at least `time`.
void sleep_until(double time);

}  // namespace palpate
