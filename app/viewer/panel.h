#pragma once
#include "app/viewer/viewer.h"

namespace palpate {

/// The controls beside the picture, as one ImGui window at the left edge. `scale`: as Gui's.
void show_panel(Viewer& viewer, float scale);

}  // namespace palpate
