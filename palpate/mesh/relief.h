#pragma once
#include "palpate/base/vectors.h"
#include "palpate/mesh/image.h"

#include <span>

namespace palpate {

/// The normal map of a height map: at each pixel the unit normal in tangent space, red along u, green along v
/// (up), blue out of the surface, with -1 to 1 stored as 0 to 255. `heights`: in pixels, rows of `width` from
/// the top down. Central differences that wrap around, so the map repeats without a seam.
Image normal_map(std::span<const float> heights, int width);

/// The normal map of a plain weave: this many threads across u (which run along v) and across v, each over
/// one and under the next. Even numbers repeat without a seam. 16 pixels a thread; 1 to 1,024 threads each
/// way.
Image weave(ivec2 threads);

}  // namespace palpate
