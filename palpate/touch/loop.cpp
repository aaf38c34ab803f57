#include "palpate/touch/loop.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

constexpr double slowest = 250, fastest = 4000;  // Hz
constexpr double watch_every = 0.001;            // s

}  // namespace

TouchLoop::TouchLoop(std::vector<Touch*> hands, LoopSettings settings)
    : hands_(std::move(hands)), settings_(settings) {
    if (!(settings.rate >= slowest && settings.rate <= fastest))
        throw Error(fmt::format("a rate of {} Hz", settings.rate), "the haptic loop",
                    fmt::format("choose one from {} to {}", slowest, fastest));
    for (Touch* hand : hands_) {
        paced_ |= hand->device().paces;
        hand->times_proxy = true;
    }
    loop_ = std::thread([this] { run(); });
    started_.wait(false);  // so that granted() has an answer
    watchdog_ = std::thread([this] { watch(); });
}

TouchLoop::~TouchLoop() {
    ends_.store(true, std::memory_order_release);
    loop_.join();
    watchdog_.join();
    for (Touch* hand : hands_) hand->let_go();
}

Granted TouchLoop::granted() const { return granted_; }

void TouchLoop::run() {
    granted_ = keep_time();
    started_.store(true, std::memory_order_release);
    started_.notify_all();
    double last = now();
    Deadlines deadlines(settings_.rate, last);
    bool first = true;
    while (!ends_.load(std::memory_order_acquire)) {
        if (!paced_) wait_for(deadlines.next());
        const double start = now();
        if (!first) timing_.periods.add(start - last);
        first = false;
        last = start;
        const double work = thread_seconds();
        tick(start);
        timing_.work.add(thread_seconds() - work);
        if (paced_) continue;
        const std::uint64_t missed = deadlines.advance(now());
        timing_.missed.fetch_add(missed, std::memory_order_relaxed);
        timing_.longest_run.store(std::max(timing_.longest_run.load(std::memory_order_relaxed), missed),
                                  std::memory_order_relaxed);
    }
}

void TouchLoop::tick(double time) {
    for (Touch* hand : hands_) {
        hand->tick(time);
        timing_.proxy.add(hand->proxy_seconds());
    }
}

void TouchLoop::wait_for(double time) const {
    if (time - now() > settings_.spin) sleep_until(time - settings_.spin);
    while (now() < time) {}
}

// Sleeps most of the time, and does so on any core, so that it needs no priority of its own as long as there
// is one to spare; but where the loop has one it asks for one too, or a spinning loop could keep it away.
void TouchLoop::watch() {
    keep_time();
    while (!ends_.load(std::memory_order_acquire)) {
        sleep_until(now() + watch_every);
        const double time = now();
        for (Touch* hand : hands_)
            if (hand->watch(time)) stalls_.fetch_add(1, std::memory_order_relaxed);
    }
}

}  // namespace palpate
