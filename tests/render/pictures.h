#pragma once
#include "palpate/mesh/image.h"

#include <algorithm>
#include <cstdlib>

// What tests ask of pictures.

namespace palpate {

/// How two pictures differ: the mean over all channels, and the share of pixels with a channel that is more
// than 16 off.
struct Difference {
    double mean = 0, share = 0;
};

inline Difference difference(const Image& a, const Image& b) {
    Difference d;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
        int most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const int off = std::abs(a.pixels[i + k] - b.pixels[i + k]);
            d.mean += off;
            most = std::max(most, off);
        }
        d.share += most > 16;
    }
    const double pixels = double(a.pixels.size() / 4);
    return {d.mean / (3 * pixels), d.share / pixels};
}

}  // namespace palpate
