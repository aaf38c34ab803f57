#pragma once
#include "palpate/viewer/controls.h"

struct ImGuiContext;

namespace palpate {

/// The controls over a viewer's picture, and the keys. There can be only one at a time. Its input is ImGui's,
/// which a window or a test feeds.
class Gui {
 public:
    /// `scale`: of text and controls, 1 on a screen of usual density.
    explicit Gui(float scale);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Lays out everything for one picture, and does what the controls are asked to. ImGui's frame must have
    /// begun.
    void build(Viewer& viewer);
    /// Draws it into the framebuffer that is bound.
    void draw();

    static constexpr char home_key = 1, escape_key = 27;
    /// Handles a key, given by its letter (A to Z), digit or sign.
    void key(Viewer& viewer, char key, bool control, bool shift);

    /// The width of the controls beside the picture, in a window of this width, pixels.
    int beside(const Viewer& viewer, int window) const;

    /// Whether the pointer is over a control, and whether text is being typed into one.
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
