#include "palpate/touch/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate {
namespace {

TEST(Durations, QuantilesAreThoseOfTheSortedList) {
    std::mt19937 random(7);
    std::lognormal_distribution<double> any(std::log(1e-3), 0.7);
    Durations counted;
    EXPECT_EQ(counted.quantile(0.5), 0);
    std::vector<double> list;
    for (int i = 0; i < 20'011; ++i) {
        list.push_back(any(random));
        counted.add(list.back());
    }
    std::sort(list.begin(), list.end());
    double sum = 0;
    for (double one : list) sum += one;
    for (double part : {0.01, 0.5, 0.99, 0.999, 1.0}) {
        const double right = list[std::min(list.size() - 1, std::size_t(part * double(list.size())))];
        EXPECT_LE(std::abs(counted.quantile(part) - right), 0.012 * right) << part;
    }
    EXPECT_EQ(counted.longest(), list.back());
    EXPECT_LE(std::abs(counted.mean() - sum / double(list.size())), 1e-12);
    std::uint64_t all = 0;
    for (const auto& bin : counted.bins()) all += bin.count;
    EXPECT_EQ(all, list.size());
}

TEST(Durations, TakesWhatIsOutOfAllBounds) {
    Durations counted;
    for (double odd : {0.0, 1e-9, -1.0, 1e9}) counted.add(odd);
    EXPECT_EQ(counted.count(), 4u);
    EXPECT_EQ(counted.longest(), 1e9);
}

TEST(Deadlines, LateRoundsAreLeftOutAndNotMadeUp) {
    Deadlines due(1000, 5);
    EXPECT_EQ(due.next(), 5);
    EXPECT_EQ(due.advance(5.0002), 0u);
    EXPECT_LE(std::abs(due.next() - 5.001), 1e-12);
    EXPECT_EQ(due.advance(5.0105), 9u);  // 5.002 to 5.010 have gone by
    EXPECT_LE(std::abs(due.next() - 5.011), 1e-9);
    EXPECT_EQ(due.advance(5.0112), 0u);
    EXPECT_EQ(due.advance(5.0139), 1u);  // a little late is late too: nothing is made up
    EXPECT_LE(std::abs(due.next() - 5.014), 1e-9);
    // Over a long time rounding does not add up to a round.
    Deadlines even(1000, 0);
    double now = 0;
    for (int i = 0; i < 1'000'000; ++i) EXPECT_EQ(even.advance(now = even.next()), 0u);
    EXPECT_LE(std::abs(even.next() - 1000), 1e-6);
}

}  // namespace
}  // namespace palpate
