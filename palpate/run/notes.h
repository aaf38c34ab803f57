#pragma once
#include "palpate/run/play.h"

#include <string>
#include <vector>

namespace palpate {

// Warnings for the user of a run: of what is likely to go wrong, and of what probably did.

/// Before it: those of build() (Models::notes); bodies that nothing holds, or that their own weight deforms
/// much; bodies inside a collider; tips and obstacles so small that they fit between the nodes.
std::vector<std::string> notes_before(const Scene& scene, const Models& made);

/// After it: inverted cells, bodies that flew away, tools that touched nothing, nodes so fast that they may
/// have tunnelled through a field, and steps of another length than requested.
std::vector<std::string> notes_after(const Scene& scene, const Models& made, const Report& report,
                                     const Play& play);

/// How many free nodes of a body are inside a collider at the start, deeper than a tenth of the spacing. Both
/// are given by their indices.
std::size_t held_at_start(const Scene& scene, const Models& made, std::size_t collider, std::size_t body);

/// Advice after a divergence, or where cells are inside out: to move a collider in which a body lies, or to
/// press it less hard.
std::string how_to_ask_less(const Scene& scene, const Report& report);

}  // namespace palpate
