#pragma once
#include "palpate/base/vectors.h"

#include <span>
#include <vector>

namespace palpate {

/// Cuts a polygon of n corners into n - 2 triangles and appends them to `out`; their indices count within
/// `corners`, and they turn as the polygon does. Each side of the polygon is a side of one triangle, so a
/// mesh that is closed stays so. The corners may be concave, lie only about in a plane, repeat, or fall in a
/// line: what has no sound triangulation (it crosses itself) still gets n - 2 triangles. Of a convex quad the
/// shorter diagonal is taken. Takes n log n for most polygons and no worse than n^1.5 for any.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& out);

}  // namespace palpate
