#include "palpate/base/parallel.h"

#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace palpate {

struct Processors::Free {
    std::atomic<int> count;

    bool take() {
        for (int now = count.load(std::memory_order_relaxed); now > 0;)
            if (count.compare_exchange_weak(now, now - 1)) return true;
        return false;
    }
    void give() { count.fetch_add(1); }
};

namespace {

// The count that a thread shares with those that it started, and with the one that started it.
thread_local Processors::Free* shared = nullptr;

class Sharing {
 public:
    Sharing(std::size_t count, const std::function<void(std::size_t)>& piece)
        : count_(count), piece_(piece) {}

    void share_out() {
        std::vector<std::jthread> helpers;
        for (std::size_t i = next_++; i < count_; i = next_++) {
            while (next_ < count_ && shared->take())
                if (!start(helpers)) break;
            do_piece(i);
        }
        helpers.clear();  // joins them
        if (error_) std::rethrow_exception(error_);
    }

 private:
    // If the system starts no more threads, the others do the work.
    bool start(std::vector<std::jthread>& helpers) {
        try {
            helpers.emplace_back([this, free = shared] {
                shared = free;
                for (std::size_t i = next_++; i < count_; i = next_++) do_piece(i);
                free->give();
            });
            return true;
        } catch (const std::system_error&) {
            shared->give();
            return false;
        }
    }

    void do_piece(std::size_t i) {
        try {
            piece_(i);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (i < failed_) failed_ = i, error_ = std::current_exception();
            next_ = count_;  // all before i have begun, so the failure with the lowest i is always found
        }
    }

    const std::size_t count_;
    const std::function<void(std::size_t)>& piece_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;
    std::size_t failed_ = std::numeric_limits<std::size_t>::max();
    std::exception_ptr error_;
};

}  // namespace

Processors::Processors(int most) : free_(new Free{most - 1}), before_(shared) { shared = free_.get(); }

Processors::~Processors() { shared = before_; }

void in_parallel(std::size_t count, const std::function<void(std::size_t)>& piece) {
    if (count == 1) return piece(0);
    if (shared) return Sharing(count, piece).share_out();
    const Processors all{int(std::thread::hardware_concurrency())};
    Sharing(count, piece).share_out();
}

}  // namespace palpate
