#pragma once
#include "palpate/body/body.h"

#include <span>

namespace palpate {

/// The largest stress that its own weight causes in a solid body, Pa, by the theory of beams. Cut into layers
/// of one cell across gravity, each layer carries what is above it, up to where the body is held (below that:
/// what hangs from it): it is pressed by that weight, and bent where that does not stand straight above. A
/// body that is held at a side only is cut the other way, and bent like a shelf. Divided by a Young's
/// modulus, it says how much the body is strained: at a few hundredths it stands, at a few tenths it sags,
/// and what is slender falls over.
///
/// `held`: nodes; a layer is held where half of its nodes are. Without any, the lowest layer stands. What
/// sticks out to a side is not looked at by itself. `gravity`: m/s². 0 for what has no cells or no weight,
/// and where what is held says too little, as a single node does.
double own_weight_stress(const Body& body, std::span<const int> held, vec3 gravity);

}  // namespace palpate
