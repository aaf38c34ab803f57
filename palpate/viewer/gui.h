#pragma once
#include "palpate/viewer/controls.h"

struct ImGuiContext;

namespace palpate {

/// The controls over a viewer's picture, and what its keys do. One at a time. Its input comes from ImGui's: a
/// window feeds that, or a test.
class Gui {
 public:
    /// `scale`: of letters and controls, 1 on a screen of usual density.
    explicit Gui(float scale);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// All of it for one picture, into the framebuffer that is bound. ImGui's new frame must have begun.
    void draw(Viewer& viewer);

    static constexpr char home_key = 1, escape_key = 27;
    /// A key by its letter (A to Z), digit or sign; one that is bound to nothing does nothing.
    void key(Viewer& viewer, char key, bool control, bool shift);

    /// How wide the controls are that stand beside the picture in a window of such a width, pixels.
    int beside(const Viewer& viewer, int window) const;

    /// Whether the pointer is over a control, and whether letters are being written into one.
    bool wants_pointer() const;
    bool wants_keys() const;

    bool shows_help = false;
    bool shows_panel = true;

 private:
    ImGuiContext* context_;
    float scale_;
    Controls controls_;
};

}  // namespace palpate
