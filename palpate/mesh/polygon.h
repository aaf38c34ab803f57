#pragma once
#include "palpate/base/vectors.h"

#include <span>
#include <vector>

namespace palpate {

/// Triangulates a polygon of n corners by ear clipping, into n - 2 triangles that are appended to `out`;
/// their indices refer to `corners`, and their winding order is that of the polygon. Each side of the polygon
/// is a side of one triangle, so a closed mesh stays closed. The polygon may be concave and not quite planar;
/// corners may repeat or be collinear. A polygon that crosses itself, and so has no proper triangulation,
/// still gets n - 2 triangles. A convex quad is split along its shorter diagonal. Takes n log n for most
/// polygons and at most n^1.5.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& out);

}  // namespace palpate
