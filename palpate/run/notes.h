#pragma once
#include "palpate/run/play.h"

#include <string>
#include <vector>

namespace palpate {

// What the user of a run should know: of what is likely to go wrong, and of what probably did.

/// Before it: bodies that nothing holds; tips and obstacles so small that they fit between the nodes.
std::vector<std::string> notes_before(const Scene& scene, const Models& made);

/// After it: cells that were inside out, bodies that went away, tools that touched nothing, obstacles so thin
/// that nodes may have passed them in one step, and steps of another length than was asked for.
std::vector<std::string> notes_after(const Scene& scene, const Models& made, const Report& report,
                                     const Play& play);

/// What would ask less of a body, or of all of them, for a message where it was too much: to press it less
/// hard if a tool presses it.
std::string how_to_ask_less(const Scene& scene, const Report& report);

}  // namespace palpate
