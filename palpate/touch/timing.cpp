#include "palpate/touch/timing.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double least = 1e-6;  // s

}  // namespace

void Durations::add(double seconds) noexcept {
    const double octave = seconds > least ? std::log2(seconds / least) : 0;
    const double bin = std::min(octave * bins_per_octave, double(bins_.size() - 1));
    constexpr auto relaxed = std::memory_order_relaxed;
    auto one_more = [](auto& counter, auto by) { counter.store(counter.load(relaxed) + by, relaxed); };
    one_more(bins_[std::size_t(bin)], 1u);
    one_more(sum_, seconds);
    longest_.store(std::max(longest_.load(relaxed), seconds), relaxed);
    one_more(count_, std::uint64_t(1));
}

std::vector<Durations::Bin> Durations::bins() const {
    std::vector<Bin> list;
    auto edge = [](std::size_t bin) { return least * std::exp2(double(bin) / bins_per_octave); };
    for (std::size_t i = 0; i < bins_.size(); ++i)
        if (const std::uint64_t inside = bins_[i].load(std::memory_order_relaxed))
            list.push_back({i == 0 ? 0 : edge(i), edge(i + 1), inside});
    return list;
}

double Durations::quantile(double part) const {
    std::uint64_t all = 0, below = 0;
    const std::vector<Bin> list = bins();
    for (const Bin& bin : list) all += bin.count;
    for (const Bin& bin : list) {
        below += bin.count;
        if (double(below) >= part * double(all)) return std::min(bin.to, longest());
    }
    return 0;
}

double Durations::mean() const {
    const std::uint64_t all = count();
    return all > 0 ? sum_.load(std::memory_order_relaxed) / double(all) : 0;
}

std::uint64_t Deadlines::advance(double now) {
    next_ += period_;
    if (now <= next_) return 0;
    const double missed = std::floor((now - next_) / period_) + 1;
    next_ += missed * period_;
    return std::uint64_t(missed);
}

}  // namespace palpate
