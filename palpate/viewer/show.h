#pragma once
#include "palpate/run/experiment.h"

#include <string>
#include <vector>

namespace palpate {

// The viewer's window in one line: each of these opens it and returns once it is closed. They throw Error if
// there is no display, or if Palpate was built without the packages of the viewer.

struct ShowSettings {
    ivec2 size = ivec2(1280, 800);  // pixels
    bool lattice = false;           // shows the springs
};

/// A body, and a surface that follows it.
void show(const Body& body, const Mesh& surface, const ShowSettings& settings = {});

/// Anything that was built.
void show(Prepared prepared, const ShowSettings& settings = {});

/// What find_scene() finds, or a recording; if `file` is empty, the window offers a choice.
void show(const std::string& file, const std::vector<Change>& changes = {},
          const ShowSettings& settings = {});

/// Whether a window could be opened: throws the same Error.
void check_window();

}  // namespace palpate
