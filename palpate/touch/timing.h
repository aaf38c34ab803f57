#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate {

/// Durations, counted in boxes each a hundredth wide, from 1 µs to 67 s. One thread adds; others
/// may ask meanwhile. Adding takes a few nanoseconds and no memory.
class Durations {
 public:
    void add(double seconds) noexcept;

    /// So much of them is no longer than this, s; exact to a hundredth. 0 of none.
    double quantile(double part) const;
    double mean() const;
    double longest() const { return longest_.load(std::memory_order_relaxed); }
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

    struct Box {
        double from, to;  // s
        std::uint64_t count;
    };
    std::vector<Box> boxes() const;  // those that hold any

 private:
    static constexpr std::size_t boxes_an_octave = 64, octaves = 26;

    std::array<std::atomic<std::uint32_t>, octaves* boxes_an_octave> boxes_ = {};
    std::atomic<std::uint64_t> count_ = 0;
    std::atomic<double> sum_ = 0, longest_ = 0;
};

/// When a loop shall go round: at even distances from its start. It does not make up what it missed.
class Deadlines {
 public:
    Deadlines(double rate, double start) : period_(1 / rate), next_(start) {}

    double next() const { return next_; }  // s

    /// After the round that was due at next(): how many rounds have gone by since. Those are left out.
    std::uint64_t advance(double now);

 private:
    double period_, next_;
};

}  // namespace palpate
