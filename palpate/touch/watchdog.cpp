#include "palpate/touch/watchdog.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr double watch_every = 0.001;  // s

}  // namespace

Watchdog::Watchdog(std::vector<Touch*> touches) : touches_(std::move(touches)) {
    if (std::ranges::count(touches_, nullptr) > 0)
        throw Error("a touch that is null", "the watchdog", "make the touch first");
    thread_ = std::thread([this] { run(); });
}

Watchdog::~Watchdog() {
    ends_.store(true, std::memory_order_release);
    thread_.join();
}

// It sleeps nearly all the time, and has priority over the loop, which may be stuck.
void Watchdog::run() {
    keep_time(true);
    while (!ends_.load(std::memory_order_acquire)) {
        sleep_until(now() + watch_every);
        const double time = now();
        for (Touch* touch : touches_)
            if (touch->watch(time)) stalls_.fetch_add(1, std::memory_order_relaxed);
    }
}

}  // namespace palpate
