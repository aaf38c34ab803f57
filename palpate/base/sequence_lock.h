#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace palpate {

/// A plain struct that one thread writes and any others read, whole. The writer never waits: what a reader
/// read while it was at it, the reader drops. Its words are atomic and ordered one by one,
/// without fences, so that this is exact in C++'s terms and not only on processors that happen to do it.
template <class T>
class SequenceLock {
    static_assert(std::is_trivially_copyable_v<T>, "what is shared is copied word by word");

 public:
    explicit SequenceLock(const T& value = T()) noexcept { store(value); }

    /// By the one writer only.
    void store(const T& value) noexcept {
        std::array<std::uint64_t, words> copy{};
        std::memcpy(copy.data(), &value, sizeof value);
        const unsigned turn = turn_.load(std::memory_order_relaxed);
        turn_.store(turn + 1, std::memory_order_relaxed);  // odd: being written
        // Whoever sees a word of this writing also sees that it had begun.
        for (std::size_t i = 0; i < words; ++i) words_[i].store(copy[i], std::memory_order_release);
        turn_.store(turn + 2, std::memory_order_release);
    }

    /// False, and `value` as it was, if the writer was at it. For a reader that may not wait, since the
    /// writer may be asleep in the middle of a word.
    bool try_load(T& value) const noexcept {
        std::array<std::uint64_t, words> copy;
        const unsigned before = turn_.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < words; ++i) copy[i] = words_[i].load(std::memory_order_acquire);
        if (before % 2 == 1 || turn_.load(std::memory_order_relaxed) != before) return false;
        std::memcpy(static_cast<void*>(&value), copy.data(), sizeof value);
        return true;
    }

    /// Waits until it has been read whole.
    T load() const noexcept {
        T value;
        while (!try_load(value)) continue;
        return value;
    }

 private:
    static constexpr std::size_t words = (sizeof(T) + 7) / 8;

    std::atomic<unsigned> turn_ = 0;
    std::array<std::atomic<std::uint64_t>, words> words_{};
};

}  // namespace palpate
