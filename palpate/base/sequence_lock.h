#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace palpate {

/// A sequence lock (seqlock): a plain struct that one thread writes and others read. The writer never waits;
/// a reader discards what it read during a write. The struct is copied as atomic words, each with its own
/// memory order and without fences, so that this is free of data races by the rules of C++, not only on
/// common processors.
template <class T>
class SequenceLock {
    static_assert(std::is_trivially_copyable_v<T>, "what is shared is copied word by word");

 public:
    explicit SequenceLock(const T& value = T()) noexcept { store(value); }

    /// For the one writer.
    void store(const T& value) noexcept {
        std::array<std::uint64_t, words> copy{};
        std::memcpy(copy.data(), &value, sizeof value);
        const unsigned turn = turn_.load(std::memory_order_relaxed);
        turn_.store(turn + 1, std::memory_order_relaxed);  // odd: being written
        // A reader that sees one of these words also sees that the write had begun.
        for (std::size_t i = 0; i < words; ++i) words_[i].store(copy[i], std::memory_order_release);
        turn_.store(turn + 2, std::memory_order_release);
    }

    /// If a write was under way: false, and `value` stays as it was. For a reader that must not wait, since
    /// the writer may be suspended in the middle of a write.
    bool try_load(T& value) const noexcept {
        std::array<std::uint64_t, words> copy;
        const unsigned before = turn_.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < words; ++i) copy[i] = words_[i].load(std::memory_order_acquire);
        if (before % 2 == 1 || turn_.load(std::memory_order_relaxed) != before) return false;
        std::memcpy(static_cast<void*>(&value), copy.data(), sizeof value);
        return true;
    }

    /// Retries until it has read a whole value.
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
