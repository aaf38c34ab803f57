#pragma once
#include "palpate/touch/touch.h"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace palpate {

/// Lets go of touches that are not ticked any more: every millisecond, on a thread of its own with the
/// highest priority that the system grants. For whoever ticks from a thread of his own, such as a vendor's
/// servo loop; a TouchLoop has one. Make it before the first tick; the touches must outlive it.
class Watchdog {
 public:
    /// Throws Error if one of the touches is not there.
    explicit Watchdog(std::vector<Touch*> touches);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// How often it had to act.
    std::uint64_t times_stalled() const { return stalls_.load(std::memory_order_relaxed); }

 private:
    void run();

    const std::vector<Touch*> touches_;
    std::atomic<bool> ends_ = false;
    std::atomic<std::uint64_t> stalls_ = 0;
    std::thread thread_;
};

}  // namespace palpate
