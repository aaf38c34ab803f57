#pragma once
#include "palpate/mesh/volume.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpate {

/// How often a volume's values occur.
struct Histogram {
    float lowest = 0, highest = 0;  // of all values
    bool whole = false;             // whether all are whole numbers
    double from = 0, to = 0;        // what the bins cover, in equal parts
    std::vector<std::size_t> counts;

    double width() const { return (to - from) / double(counts.size()); }
};

/// Counts a volume's values in at most `bins` bins from the lowest to the highest. Whole numbers of a smaller
/// range have a bin each, with the number in its middle. Where a ten-thousandth of the values at either end
/// would take more than three quarters of that range, the bins cover the range of the others, and the first
/// and the last bin count all that lie beyond.
Histogram histogram(const Volume& volume, int bins = 256);

/// For each of these percents the smallest of the values that at least so many percent of them do not exceed
/// (the nearest rank): always one of the values. They are taken, because they are put in another order. NaN
/// does not count as a value. Throws Error if there is no value, or a percent is not from 0 to 100.
std::vector<float> percentiles(std::vector<float>&& values, std::span<const double> percents);

/// A value for isosurface() that parts what is dark from what is bright: Otsu's threshold, halfway between
/// two whole numbers if all values are whole. Nothing if all values are equal.
std::optional<float> suggested_iso(const Histogram& histogram);

}  // namespace palpate
