#pragma once
#include "palpate/base/vectors.h"
#include "palpate/mesh/image.h"

#include <span>

namespace palpate {

/// The normal map of a relief: at each pixel the unit normal, red along u, green along v (up), blue out of
/// the surface, from -1 to 1 as 0 to 255. `heights`: rows from the top down, `width` of them a row, in
/// pixels. Differences are central and wrap round, so what repeats does so without a seam.
Image normal_map(std::span<const float> heights, int width);

/// The normal map of a plain weave: so many threads across u (each runs along v) and across v, over one and
/// under the next. Even numbers repeat without a seam. 16 pixels a thread; 1 to 128 of them each way.
Image weave(ivec2 threads);

}  // namespace palpate
