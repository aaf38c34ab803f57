#pragma once
#include "palpate/viewer/viewer.h"

namespace palpate {

/// Sliders of ImGui. The pointer holds at most one slider at a time.
class Sliders {
 public:
    /// Whether a slider has moved, and whether it has moved before while held: then both are one change.
    struct Slid {
        bool moved = false, again = false;
    };
    /// For the control before this.
    Slid slid(bool moved);
    Slid slide(const char* label, float& value, float low, float high, const char* format,
               bool logarithmic = false);
    /// For a change that takes the solver long: true once the slider is released.
    bool slide_and_let_go(const char* label, float& value, float low, float high, const char* format);

 private:
    bool has_moved_ = false;  // since it was grasped
    unsigned held_ = 0;       // ImGui's id of the slider that is held
    float at_ = 0;            // its value
};

/// The controls beside the picture, as one ImGui window at the left edge.
class Controls {
 public:
    /// `scale`: as in Gui.
    void show(Viewer& viewer, float scale);

 private:
    void show_hand(Viewer& viewer);
    void show_feel(Viewer& viewer);
    void show_motion(Viewer& viewer);
    void show_step(Viewer& viewer);
    void show_body(Viewer& viewer, std::size_t b);
    void show_surroundings(Viewer& viewer);

    Sliders sliders_;
    char file_[512] = "";  // of the device, while it is being typed
};

}  // namespace palpate
