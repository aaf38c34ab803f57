#pragma once
#include "palpate/body/collider.h"

#include <optional>

namespace palpate {

/// The bounding box of a collider: the smallest oriented box along the shape's own sides, with rounded edges,
/// that contains it, without the collider's margin. A plane has none.
std::optional<Box> bounding_box(const Collider& collider);

}  // namespace palpate
