#include "palpate/mesh/histogram.h"

#include "palpate/base/error.h"
#include "palpate/voxels/isosurface.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace palpate {
namespace {

Volume volume_with(std::vector<float> values) {
    Volume volume;
    volume.dims = ivec3(int(values.size()), 1, 1);
    volume.values = std::move(values);
    return volume;
}

// So many values about each of two means.
Volume two_bells(std::size_t dark, double mean, std::size_t bright, double other_mean, double deviation) {
    std::mt19937 random(3);
    std::normal_distribution<double> bell(0, deviation);
    std::vector<float> values;
    for (std::size_t i = 0; i < dark + bright; ++i)
        values.push_back(float((i < dark ? mean : other_mean) + bell(random)));
    return volume_with(values);
}

std::size_t total(const Histogram& h) {
    return std::accumulate(h.counts.begin(), h.counts.end(), std::size_t(0));
}

TEST(Histogram, CountsEveryValueInItsBin) {
    const Volume volume = rubble({37, 23, 11}, 1);
    const Histogram h = histogram(volume, 100);
    EXPECT_EQ(h.counts.size(), 100u);
    EXPECT_FALSE(h.whole);
    EXPECT_EQ(h.lowest, *std::min_element(volume.values.begin(), volume.values.end()));
    EXPECT_EQ(h.highest, *std::max_element(volume.values.begin(), volume.values.end()));
    EXPECT_EQ(total(h), volume.count());
    for (std::size_t bin = 1; bin + 1 < 100; ++bin) {  // the ends may differ by a rounding
        const double low = h.from + h.width() * double(bin), high = h.from + h.width() * double(bin + 1);
        const auto within = std::count_if(volume.values.begin(), volume.values.end(),
                                          [&](float v) { return low <= v && v < high; });
        EXPECT_LE(std::abs(double(within) - double(h.counts[bin])), 1);
    }
}

TEST(Histogram, GivesWholeNumbersABinEach) {
    const Histogram h = histogram(volume_with({-2, 0, 0, 1, 3, 3, 3}));
    EXPECT_TRUE(h.whole);
    EXPECT_EQ(h.counts, (std::vector<std::size_t>{1, 0, 2, 1, 0, 3}));
    EXPECT_EQ(h.from, -2.5);
    EXPECT_EQ(h.to, 3.5);
}

TEST(Percentiles, AreThoseOfTheSortedValues) {
    const std::vector<double> percents{99, 0, 0.1, 25, 50, 66, 99.9, 1, 100};  // in any order
    const std::vector<float> values = two_bells(2000, 100, 1000, 400, 30).values;
    std::vector<float> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const std::vector<float> found = percentiles(std::vector(values), percents);
    ASSERT_EQ(found.size(), percents.size());
    for (std::size_t i = 0; i < percents.size(); ++i) {
        // So many do not exceed it, and of what is smaller that is not so.
        const double wanted = percents[i] / 100 * double(values.size());
        const auto below = std::lower_bound(sorted.begin(), sorted.end(), found[i]) - sorted.begin();
        const auto up_to = std::upper_bound(sorted.begin(), sorted.end(), found[i]) - sorted.begin();
        EXPECT_GE(double(up_to), wanted - 1e-9) << percents[i];
        EXPECT_TRUE(double(below) < wanted || below == 0) << percents[i];
    }
}

TEST(Percentiles, OfWholeNumbersAreWholeNumbers) {
    // As most of an image of a head: air, in more different values than a table of bars has bars.
    std::vector<float> values(700, 0);
    for (int i = 0; i < 300; ++i) values.push_back(float(100 + 3 * i));
    EXPECT_EQ(percentiles(std::move(values), std::vector<double>{1, 25, 50, 70, 75, 99}),
              (std::vector<float>{0, 0, 0, 0, 247, 967}));
    EXPECT_EQ(percentiles({16777215, -3, 5}, std::vector<double>{1, 50, 99}),
              (std::vector<float>{-3, 5, 16777215}));
}

TEST(Percentiles, LeaveOutWhatIsNoNumberAndNeedOne) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(percentiles({nan, 3, nan, 1, 2, nan}, std::vector<double>{0, 50, 100}),
              (std::vector<float>{1, 2, 3}));
    const std::vector<double> half{50};
    EXPECT_THROW(percentiles({}, half), Error);
    EXPECT_THROW(percentiles({nan, nan}, half), Error);
    for (double percent : {-1.0, 100.5, double(nan)})
        EXPECT_THROW(percentiles({1, 2}, std::vector{percent}), Error) << percent;
}

// Of two bells of one width and height, the best threshold is halfway.
TEST(SuggestedIso, IsHalfwayBetweenTwoLikeBells) {
    for (double scale : {1e-6, 1.0, 1e6}) {
        const Histogram h = histogram(two_bells(50000, 100 * scale, 50000, 300 * scale, 30 * scale));
        EXPECT_LE(std::abs(suggested_iso(h).value() - 200 * scale), 2 * h.width());
    }
}

// Otsu's threshold is the one that leaves the least variance in the two parts.
TEST(SuggestedIso, LeavesTheLeastVariance) {
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        std::vector<float> values;
        for (int i = 0; i < 500; ++i) values.push_back(float(random() % 3 * (random() % 40)));
        auto variance_left = [&](double threshold) {
            double left = 0;
            for (bool bright : {false, true}) {
                double n = 0, sum = 0, squares = 0;
                for (double v : values)
                    if ((v > threshold) == bright) n += 1, sum += v, squares += v * v;
                if (n > 0) left += squares - sum * sum / n;
            }
            return left;
        };
        double least = INFINITY;
        for (double threshold = 0.5; threshold < 80; ++threshold)
            least = std::min(least, variance_left(threshold));
        const float iso = suggested_iso(histogram(volume_with(values))).value();
        EXPECT_LE(variance_left(iso), least * (1 + 1e-9)) << round;
        EXPECT_EQ(iso - std::floor(iso), 0.5f);
    }
}

TEST(SuggestedIso, IsInTheMiddleOfAGap) {
    EXPECT_EQ(suggested_iso(histogram(volume_with({0, 0, 0, 1, 1}))), 0.5f);
    EXPECT_EQ(suggested_iso(histogram(volume_with({0, 0, 0, 99, 99}))), 49.5f);
    EXPECT_LE(std::abs(suggested_iso(histogram(volume_with({0.25f, 0.25f, 0.75f}))).value() - 0.5f), 0.003f);
}

TEST(SuggestedIso, IsNoneWhereAllValuesAreEqual) {
    for (float value : {0.0f, 7.0f, -0.3f, 1e38f, -1e-40f})
        EXPECT_FALSE(suggested_iso(histogram(volume_with(std::vector<float>(9, value)))));
}

TEST(SuggestedIso, HeedsNoOutliers) {
    for (float outlier : {1e4f, 1e20f, 3e38f, -3e38f}) {
        Volume volume = two_bells(50000, 100, 50000, 300, 30);
        for (std::size_t i : {7, 70000, 500}) volume.values[i] = outlier;
        const Histogram h = histogram(volume);
        EXPECT_EQ(total(h), volume.count());
        EXPECT_LE(std::abs(suggested_iso(h).value() - 200), 5) << outlier;
    }
}

TEST(SuggestedIso, FindsAFewVoxelsInNothing) {
    std::vector<float> values(100000);
    values[3] = values[4] = 100;
    EXPECT_EQ(suggested_iso(histogram(volume_with(values))), 50.5f);
}

TEST(SuggestedIso, AlwaysGivesASurface) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        Volume volume = rubble({5, 6, 7}, seed);
        if (seed % 2)
            for (float& value : volume.values) value = std::round(value * float(seed) * 1000);
        EXPECT_FALSE(isosurface(volume, suggested_iso(histogram(volume)).value()).triangles.empty());
    }
}

}  // namespace
}  // namespace palpate
