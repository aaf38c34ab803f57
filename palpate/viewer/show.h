#pragma once
#include "palpate/run/experiment.h"

#include <string>
#include <vector>

namespace palpate {

// The viewer's window in one line: each of these opens it and returns once it is closed. They throw Error
// where there is no display, and where Palpate was built without what a window needs.

struct ShowSettings {
    ivec2 size = ivec2(1280, 800);  // pixels
    bool lattice = false;           // shows the springs
};

/// A body, and a surface that is hung on it.
void show(const Body& body, const Mesh& surface, const ShowSettings& settings = {});

/// Whatever was built or made.
void show(Prepared prepared, const ShowSettings& settings = {});

/// What find_scene() finds, or a recording; where `file` is empty, the window lets one choose.
void show(const std::string& file, const std::vector<Change>& changes = {},
          const ShowSettings& settings = {});

/// Whether a window could be opened: throws the same Error.
void check_window();

}  // namespace palpate
