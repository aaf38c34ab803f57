#pragma once
#include "palpate/scene/scene.h"

#include <string>
#include <vector>

/// Opens a scene in a window, until it is closed: view.cpp; or where the viewer was not built, no_view.cpp,
/// which throws Error that says so. `file`: what find_scene() finds, or a recording; where it is empty, the
/// window lets one choose. `size`: of the window; `lattice`: shows the springs.
void view(const std::string& file, const std::vector<palpate::Change>& changes, palpate::ivec2 size,
          bool lattice);

/// Whether it could: throws the same Error.
void check_view();
