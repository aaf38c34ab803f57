#include "palpate/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace palpate {
namespace {

TEST(Parallel, DoesEachOnce) {
    for (int most : {1, 2, 7})
        for (std::size_t count : {0u, 1u, 2u, 1000u, 1001u})
            for (std::size_t at_once : {1u, 3u, 2000u}) {
                const Processors some(most);
                std::vector<int> done(count);
                parallel_for(count, at_once, [&](std::size_t i) { ++done[i]; });
                EXPECT_EQ(done, std::vector<int>(count, 1));
            }
}

// Halves of halves, as trees are built.
long sum(long first, long last) {
    if (last - first == 1) return first;
    const long middle = (first + last) / 2;
    long low = 0, high = 0;
    parallel_invoke([&] { low = sum(first, middle); }, [&] { high = sum(middle, last); });
    return low + high;
}

TEST(Parallel, CallsItselfAsDeepAsItIsAsked) {
    EXPECT_EQ(sum(0, 2000), 1999000);
    const Processors three(3);
    EXPECT_EQ(sum(0, 2000), 1999000);
}

TEST(Parallel, WorksWithNoMoreThreadsThanProcessors) {
    for (int most : {1, 2, 5}) {
        const Processors some(most);
        std::atomic<int> at_work = 0, largest = 0;
        parallel_for(8, 1, [&](std::size_t) {
            parallel_for(50, 1, [&](std::size_t) {
                const int now = ++at_work;
                for (int seen = largest; seen < now && !largest.compare_exchange_weak(seen, now);) {}
                std::this_thread::sleep_for(std::chrono::microseconds(50));
                --at_work;
            });
        });
        EXPECT_LE(largest, most);
        EXPECT_EQ(at_work, 0);
    }
}

TEST(Parallel, ThrowsWhatTheFirstThrew) {
    for (int most : {1, 4}) {
        const Processors some(most);
        for (std::size_t first : {0u, 17u, 99u}) {
            std::atomic<std::size_t> done = 0;
            try {
                parallel_for(100, 1, [&](std::size_t i) {
                    if (i >= first) throw std::runtime_error(std::to_string(i));
                    ++done;
                });
                ADD_FAILURE() << "nothing is thrown";
            } catch (const std::runtime_error& error) {
                EXPECT_EQ(error.what(), std::to_string(first));
            }
            EXPECT_EQ(done, first);
        }
    }
}

}  // namespace
}  // namespace palpate
