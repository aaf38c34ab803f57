#pragma once
#include "palpate/touch/touch.h"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace palpate {

/// A watchdog: stops the devices of touches whose loop has stalled. It checks every millisecond, on a thread
/// of its own with the highest priority that the system grants. For programs that tick from a thread of their
/// own, such as a vendor's servo loop; a TouchLoop has one already. Make it before the first tick; the
/// touches must outlive it.
class Watchdog {
 public:
    /// Throws Error if one of the touches is null.
    explicit Watchdog(std::vector<Touch*> touches);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// How often it has intervened.
    std::uint64_t times_stalled() const { return stalls_.load(std::memory_order_relaxed); }

 private:
    void run();

    const std::vector<Touch*> touches_;
    std::atomic<bool> ends_ = false;
    std::atomic<std::uint64_t> stalls_ = 0;
    std::thread thread_;
};

}  // namespace palpate
