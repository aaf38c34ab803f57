#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace palpate {

/// A ring buffer: a lock-free, wait-free queue from one writer to one reader, which loses nothing and keeps
/// the order. A full ring takes no more, and an empty one gives none.
template <class T, std::size_t size>
class RingBuffer {
 public:
    /// For the writer. False if it is full.
    bool put(const T& value) noexcept {
        const std::size_t put = put_.load(std::memory_order_relaxed);
        if (put - taken_.load(std::memory_order_acquire) == size) return false;
        places_[put % size] = value;
        put_.store(put + 1, std::memory_order_release);
        return true;
    }

    /// For the reader. If it is empty: false, and `value` stays as it was.
    bool take(T& value) noexcept {
        const std::size_t taken = taken_.load(std::memory_order_relaxed);
        if (taken == put_.load(std::memory_order_acquire)) return false;
        value = places_[taken % size];
        taken_.store(taken + 1, std::memory_order_release);
        return true;
    }

 private:
    static_assert((size & (size - 1)) == 0, "a power of two, so that the counters may overflow");

    std::array<T, size> places_ = {};
    std::atomic<std::size_t> put_ = 0, taken_ = 0;
};

}  // namespace palpate
