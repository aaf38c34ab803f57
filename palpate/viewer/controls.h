#pragma once
#include "palpate/viewer/viewer.h"

namespace palpate {

/// Sliders of ImGui. There is one pointer, and it holds one slider at a time.
class Sliders {
 public:
    /// Whether a slider has moved, and whether it has been moving before: then both are one change.
    struct Slid {
        bool moved = false, again = false;
    };
    /// Of the control before this.
    Slid slid(bool moved);
    Slid slide(const char* label, float& value, float low, float high, const char* format,
               bool logarithmic = false);
    /// For what takes the solver a while: true once it is let go of.
    bool slide_and_let_go(const char* label, float& value, float low, float high, const char* format);

 private:
    bool has_moved_ = false;  // since it was taken hold of
    unsigned held_ = 0;       // ImGui's number of the one that is let go of later
    float at_ = 0;            // where that is
};

/// The controls beside the picture, as one ImGui window at the left edge.
class Controls {
 public:
    /// `scale`: as Gui's.
    void show(Viewer& viewer, float scale);

 private:
    void show_hand(Viewer& viewer);
    void show_dent_width(Viewer& viewer);
    void show_motion(Viewer& viewer);
    void show_step(Viewer& viewer);
    void show_body(Viewer& viewer, std::size_t b);
    void show_surroundings(Viewer& viewer);

    Sliders sliders_;
    char file_[512] = "";  // of the device, as it is being written
};

}  // namespace palpate
