#include "palpate/base/sequence_lock.h"

#include <gtest/gtest.h>

#include <thread>

namespace palpate {
namespace {

struct Odd {  // no whole number of words, and with a gap
    char letter = 'a';
    double number = 0;
    std::array<short, 5> more{};
};

TEST(SequenceLock, KeepsWhatWasStored) {
    SequenceLock<Odd> shared(Odd{'b', 2.5, {1, 2, 3, 4, 5}});
    EXPECT_EQ(shared.load().letter, 'b');
    shared.store({'c', -1.0 / 3, {5, 4, 3, 2, 1}});
    Odd now;
    ASSERT_TRUE(shared.try_load(now));
    EXPECT_EQ(now.letter, 'c');
    EXPECT_EQ(now.number, -1.0 / 3);
    EXPECT_EQ(now.more, (std::array<short, 5>{5, 4, 3, 2, 1}));
}

TEST(SequenceLock, ReadersNeverSeeHalfAWriting) {
    struct Many {
        std::array<std::uint64_t, 37> same{};
    };
    SequenceLock<Many> shared;
    std::atomic<bool> over = false;
    std::atomic<int> torn = 0, backward = 0, reads = 0;
    auto read = [&] {
        std::uint64_t last = 0;
        for (Many now; !over || last == 0;) {
            if (!shared.try_load(now)) now = shared.load();
            for (std::uint64_t word : now.same) torn += word != now.same[0];
            backward += now.same[0] < last;
            last = now.same[0];
            ++reads;
        }
    };
    std::thread one(read), other(read);
    Many next;
    for (int i = 1; i <= 200'000; ++i) {
        next.same.fill(std::uint64_t(i));
        shared.store(next);
    }
    over = true;
    one.join();
    other.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backward, 0);
    EXPECT_GE(reads, 2);
    EXPECT_EQ(shared.load().same[36], 200'000u);
}

}  // namespace
}  // namespace palpate
