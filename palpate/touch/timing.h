#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate {

/// A histogram of durations from 1 µs to 67 s, in logarithmic bins that are a hundredth wide. One thread
/// adds; others may read meanwhile. Adding takes a few nanoseconds and allocates nothing.
class Durations {
 public:
    void add(double seconds) noexcept;

    /// The quantile, s: this part (0 to 1) of the durations is no longer. Exact to a hundredth; 0 if there
    /// are none.
    double quantile(double part) const;
    double mean() const;
    double longest() const { return longest_.load(std::memory_order_relaxed); }
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

    struct Bin {
        double from, to;  // s
        std::uint64_t count;
    };
    std::vector<Bin> bins() const;  // those that are not empty

 private:
    static constexpr std::size_t bins_per_octave = 64, octaves = 26;

    std::array<std::atomic<std::uint32_t>, octaves* bins_per_octave> bins_ = {};
    std::atomic<std::uint64_t> count_ = 0;
    std::atomic<double> sum_ = 0, longest_ = 0;
};

/// The deadlines of a periodic loop, at even distances from its start. It skips those that it missed.
class Deadlines {
 public:
    Deadlines(double rate, double start) : period_(1 / rate), next_(start) {}

    double next() const { return next_; }  // s

    /// To be called after the tick that was due at next(): moves on, and returns how many ticks were missed
    /// and are skipped.
    std::uint64_t advance(double now);

 private:
    double period_, next_;
};

}  // namespace palpate
