#include "palpate/base/team.h"

#include "palpate/base/error.h"

namespace palpate {
namespace {

// Tells the processor that this thread spins.
void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

// Waits until a counter changes from a value. Within run() that takes microseconds; between calls it may take
// long.
void wait_while(const std::atomic<unsigned>& counter, unsigned value) {
    constexpr int spins = 4000;  // some 50 to 100 µs
    for (int i = 0; i < spins; ++i) {
        if (counter.load(std::memory_order_acquire) != value) return;
        pause();
    }
    while (counter.load(std::memory_order_acquire) == value) counter.wait(value, std::memory_order_acquire);
}

}  // namespace

Team::Team(int members) {
    if (members < 1 || members > 1024)
        throw Error(std::to_string(members) + " members", "a team", "use 1 to 1,024");
    for (int member = 1; member < members; ++member)
        threads_.emplace_back([this, member] { stand_by(member); });
}

Team::~Team() {
    work_ = nullptr;
    calls_.fetch_add(1, std::memory_order_release);
    calls_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Team::run(const std::function<void(int)>& work) {
    if (!threads_.empty()) {
        work_ = &work;
        calls_.fetch_add(1, std::memory_order_release);
        calls_.notify_all();
    }
    work(0);
    meet();
}

void Team::meet() {
    if (threads_.empty()) return;
    const unsigned meeting = meetings_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < unsigned(members())) {
        wait_while(meetings_, meeting);
        return;
    }
    arrived_.store(0, std::memory_order_relaxed);
    meetings_.fetch_add(1, std::memory_order_release);
    meetings_.notify_all();
}

void Team::stand_by(int member) {
    for (unsigned calls = 0;; ++calls) {
        wait_while(calls_, calls);
        if (!work_) return;
        (*work_)(member);
        meet();
    }
}

}  // namespace palpate
