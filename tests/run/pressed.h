#pragma once
// What tests of runs share.
#include "palpate/run/run.h"

#include <algorithm>
#include <string>
#include <vector>

namespace palpate {

// A soft block on a table, pressed in the middle from above.
inline const std::string pressed = R"(
[simulation]
duration = 1.2
[camera]
eye = [0.15, 0.12, 0.2]
look_at = "block"
[[body]]
name = "block"
dims = [11, 6, 11]
spacing = 0.01
youngs_modulus = 8000
density = 1000
damping = 10
pin = { below = 0 }
[[tool]]
name = "finger"
radius = 0.012
stiffness = 600
from = [0.05, 0.3, 0.05]
along = [0, -1, 0]
path = [[0.4, 0, 0.002, 0], [0.8, 0, -0.01, 0], [1.1, 0, -0.01, 0]]
)";

inline Scene scene(const std::vector<Change>& changes = {}) {
    return parse_scene(pressed, "block.toml", ".", changes);
}

inline bool has_note(const Report& report, const std::string& words) {
    return std::ranges::any_of(report.notes,
                               [&](const std::string& note) { return note.find(words) != note.npos; });
}

}  // namespace palpate
