#pragma once
#include "palpate/body/collider.h"

#include <optional>

namespace palpate {

/// The smallest box along a shape's own sides, with rounded edges, that holds it, without the collider's
/// margin. A plane has none.
std::optional<Box> bounding_box(const Collider& collider);

}  // namespace palpate
