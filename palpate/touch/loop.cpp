#include "palpate/touch/loop.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace palpate {
namespace {

constexpr double slowest = 250, fastest = 4000;  // Hz
constexpr double longest_spin = 0.001;           // s: more would keep others off the processor

}  // namespace

TouchLoop::TouchLoop(std::vector<Touch*> touches, LoopSettings settings)
    : touches_(std::move(touches)), settings_(settings), watchdog_(touches_) {
    if (!(settings.rate >= slowest && settings.rate <= fastest))
        throw Error(fmt::format("a rate of {} Hz", settings.rate), "the haptic loop",
                    fmt::format("choose one from {} to {}", slowest, fastest));
    if (!(settings.spin >= 0 && settings.spin <= longest_spin))
        throw Error(fmt::format("a spin of {} s", settings.spin), "the haptic loop",
                    fmt::format("choose one from 0 to {}", longest_spin));
    for (Touch* touch : touches_) paced_ |= touch->device().paces;
    if (!paced_)
        for (Touch* touch : touches_) touch->expect_rate(settings.rate);
    loop_ = std::thread([this] { run(); });
    started_.wait(false);  // so that granted() is known
}

// The watchdog runs until the loop has ended, which may hang in a device at its end.
TouchLoop::~TouchLoop() {
    ends_.store(true, std::memory_order_release);
    for (Touch* touch : touches_) touch->let_go();
    loop_.join();
    for (Touch* touch : touches_) touch->let_go();
}

Granted TouchLoop::granted() const { return granted_; }

void TouchLoop::run() {
    granted_ = keep_time();
    started_.store(true, std::memory_order_release);
    started_.notify_all();
    Deadlines deadlines(settings_.rate, now());
    std::optional<double> last;
    bool answered = false;
    while (!ends_.load(std::memory_order_acquire)) {
        const bool follows = paced_ && answered;  // a device that is gone does not pace the loop
        if (!follows) wait_for(deadlines.next());
        const double start = now();
        if (last) timing_.periods.add(start - *last);
        last = start;
        const double work = thread_seconds();
        answered = tick(start);
        timing_.work.add(thread_seconds() - work);
        const std::uint64_t missed = deadlines.advance(now());
        if (follows) continue;
        timing_.missed.fetch_add(missed, std::memory_order_relaxed);
        timing_.longest_run.store(std::max(timing_.longest_run.load(std::memory_order_relaxed), missed),
                                  std::memory_order_relaxed);
    }
}

bool TouchLoop::tick(double time) {
    bool all = true;
    for (Touch* touch : touches_) {
        double proxy = 0;
        all &= touch->tick(time, &proxy);
        timing_.proxy.add(proxy);
    }
    return all;
}

void TouchLoop::wait_for(double time) const {
    if (time - now() > settings_.spin) sleep_until(time - settings_.spin);
    while (now() < time) {}
}

}  // namespace palpate
