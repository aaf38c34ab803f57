#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace palpate {

/// Passes values from one thread to another, all of them and in their order. Neither ever waits: a full ring
/// takes no more, and an empty one gives none.
template <class T, std::size_t size>
class RingBuffer {
 public:
    /// The writer's. False if it is full.
    bool put(const T& value) noexcept {
        const std::size_t put = put_.load(std::memory_order_relaxed);
        if (put - taken_.load(std::memory_order_acquire) == size) return false;
        places_[put % size] = value;
        put_.store(put + 1, std::memory_order_release);
        return true;
    }

    /// The reader's. False, and `value` as it was, if it is empty.
    bool take(T& value) noexcept {
        const std::size_t taken = taken_.load(std::memory_order_relaxed);
        if (taken == put_.load(std::memory_order_acquire)) return false;
        value = places_[taken % size];
        taken_.store(taken + 1, std::memory_order_release);
        return true;
    }

 private:
    static_assert((size & (size - 1)) == 0, "a power of two, so that the counts may overflow");

    std::array<T, size> places_ = {};
    std::atomic<std::size_t> put_ = 0, taken_ = 0;
};

}  // namespace palpate
