#pragma once
#include "palpate/run/play.h"

#include <string>
#include <vector>

namespace palpate {

// What the user of a run should know: of what is likely to go wrong, and of what probably did.

/// Before it: what building it found (Models::notes); bodies that nothing holds; bodies that a collider holds
/// inside it; tips and obstacles so small that they fit between the nodes.
std::vector<std::string> notes_before(const Scene& scene, const Models& made);

/// After it: cells that were inside out, bodies that went away, tools that touched nothing, obstacles so thin
/// that nodes may have passed them in one step, and steps of another length than was asked for.
std::vector<std::string> notes_after(const Scene& scene, const Models& made, const Report& report,
                                     const Play& play);

/// How many nodes of a body that are free to move lie in a collider at the start, deeper than a tenth of the
/// spacing. Both are named by their numbers from 0.
std::size_t held_at_start(const Scene& scene, const Models& made, std::size_t collider, std::size_t body);

/// What would ask less of a body, or of all of them, for a message where it was too much: to move a collider
/// that it lies in, or to press it less hard if a tool presses it.
std::string how_to_ask_less(const Scene& scene, const Report& report);

}  // namespace palpate
