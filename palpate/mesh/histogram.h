#pragma once
#include "palpate/mesh/volume.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpate {

/// A histogram of a volume's values.
struct Histogram {
    float lowest = 0, highest = 0;  // of all values
    bool whole = false;             // whether all are whole numbers
    double from = 0, to = 0;        // the range of the bins, which are equally wide
    std::vector<std::size_t> counts;

    double width() const { return (to - from) / double(counts.size()); }
};

/// Counts a volume's values in at most `bins` bins from the lowest to the highest. Whole numbers of a smaller
/// range get one bin each, centred on the number. If outliers, a ten-thousandth of the values at either end,
/// would take more than three quarters of that range, the bins cover the range of the others, and the first
/// and the last bin count the outliers.
Histogram histogram(const Volume& volume, int bins = 256);

/// The percentiles of values by nearest rank: each is one of the values. `values` is taken over, because it
/// is reordered. NaN is ignored. Throws Error if there is no value, or if a percentage is not from 0 to 100.
std::vector<float> percentiles(std::vector<float>&& values, std::span<const double> percents);

/// A value for isosurface() that separates dark from bright: Otsu's threshold, halfway between two whole
/// numbers if all values are whole. Nothing if all values are equal.
std::optional<float> suggested_iso(const Histogram& histogram);

}  // namespace palpate
