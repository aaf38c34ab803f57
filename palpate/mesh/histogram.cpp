#include "palpate/mesh/histogram.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double rare = 1e-4;    // this part of the values at either end may be outliers,
constexpr double narrow = 0.25;  // if the others take up less than this part of the range

struct Range {
    double low, high;
};

// The bin of a value; the first if bins have no width.
std::size_t bin_of(const Histogram& histogram, double value) {
    const double width = std::max(histogram.width(), std::numeric_limits<double>::min());
    return std::size_t(
        std::clamp((value - histogram.from) / width, 0.0, double(histogram.counts.size() - 1)));
}

void count(Histogram& histogram, const Volume& volume, Range range, int bins) {
    const double numbers = range.high - range.low + 1;
    const bool one_each = histogram.whole && numbers <= bins;
    histogram.from = one_each ? range.low - 0.5 : range.low;
    histogram.to = one_each ? range.high + 0.5 : range.high;
    histogram.counts.assign(std::size_t(one_each ? numbers : bins), 0);
    for (double value : volume.values) ++histogram.counts[bin_of(histogram, value)];
}

// The range of the values without the outliers at either end.
Range common(const Histogram& histogram, const Volume& volume) {
    const auto& counts = histogram.counts;
    auto skip_rare = [&](auto bin) {
        double sum = double(*bin);
        while (sum <= rare * double(volume.values.size())) sum += double(*++bin);
        return bin;
    };
    const auto first = std::size_t(skip_rare(counts.begin()) - counts.begin());
    const auto beyond = std::size_t(skip_rare(counts.rbegin()).base() - counts.begin());
    Range range{histogram.highest, histogram.lowest};
    for (double value : volume.values)
        if (const std::size_t bin = bin_of(histogram, value); first <= bin && bin < beyond)
            range = {std::min(range.low, value), std::max(range.high, value)};
    return range;
}

}  // namespace

Histogram histogram(const Volume& volume, int bins) {
    if (volume.values.empty() || bins < 2)
        throw Error("no values, or fewer than 2 bins", "the histogram of " + volume.name,
                    "give it at least one value and 2 bins");
    Histogram histogram;
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    histogram.lowest = *low, histogram.highest = *high;
    histogram.whole = std::all_of(volume.values.begin(), volume.values.end(),
                                  [](float value) { return value == std::floor(value); });
    Range range{*low, *high};
    for (bool again = true; again;) {
        count(histogram, volume, range, bins);
        const Range middle = common(histogram, volume);
        again = middle.high > middle.low && middle.high - middle.low < narrow * (range.high - range.low);
        range = middle;
    }
    return histogram;
}

std::vector<float> percentiles(std::vector<float>&& values, std::span<const double> percents) {
    std::erase_if(values, [](float value) { return std::isnan(value); });
    if (values.empty()) throw Error("no values", "the percentiles", "give at least one that is a number");
    std::vector<float> found;
    for (const double percent : percents) {
        if (!(0 <= percent && percent <= 100))
            throw Error(fmt::format("{} %", percent), "the percentiles", "ask for 0 to 100 %");
        const double rank = std::ceil(percent / 100 * double(values.size()));
        const auto nth = values.begin() + std::ptrdiff_t(std::clamp(rank, 1.0, double(values.size()))) - 1;
        std::nth_element(values.begin(), nth, values.end());
        found.push_back(*nth);
    }
    return found;
}

std::optional<float> suggested_iso(const Histogram& histogram) {
    const auto& counts = histogram.counts;
    double all = 0, sum = 0;  // of values, and of their bin numbers
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        all += double(counts[bin]);
        sum += double(counts[bin]) * double(bin);
    }
    // If no value lies between dark and bright, all thresholds there are equally good: it takes the middle
    // one.
    double best = 0, dark = 0, dark_sum = 0;
    std::size_t first = 0, last = 0;
    for (std::size_t bin = 0; bin + 1 < counts.size(); ++bin) {
        dark += double(counts[bin]);
        dark_sum += double(counts[bin]) * double(bin);
        if (dark == 0 || dark == all) continue;
        const double apart = dark_sum / dark - (sum - dark_sum) / (all - dark);
        const double parted = dark * (all - dark) * apart * apart;
        if (parted > best) best = parted, first = bin;
        if (parted == best) last = bin;
    }
    double threshold = histogram.from + histogram.width() * (0.5 * double(first + last) + 1);
    if (histogram.whole) threshold = std::floor(threshold) + 0.5;
    const float iso = float(threshold);
    if (!(histogram.lowest < iso && iso < histogram.highest)) return {};
    return iso;
}

}  // namespace palpate
