#pragma once
#include "palpate/viewer/orbit.h"
#include "palpate/viewer/pane.h"
#include "palpate/viewer/session.h"

namespace palpate {

/// The views of what is open: one picture, or two side by side, from an orbit camera.
class Views {
 public:
    Views(const gl::Context& context, ivec2 size, const Session& session, const Options& options);

    Orbit orbit;

    /// Sets the size, and how far to the right in the window it begins.
    void resize(ivec2 size, int left);
    ivec2 size() const { return size_; }
    int left() const { return left_; }
    /// The size of one of the pictures.
    ivec2 view_size() const;
    /// The camera of one of them. In narrow pictures it widens the angle, to show the same width.
    Camera camera() const;
    /// The view with the pointer at a pixel; side by side, both halves show the same point.
    Sight sight(vec2 pixel) const;

    /// Returns to the scene's own camera.
    void go_home();

    /// Must be called when something has moved or looks different.
    void wake();

    /// Takes a copy of what shall be drawn, as a draft if the options say so. `always`: even if nothing has
    /// moved.
    void look(const Traces& traces, bool always, bool may_be_draft);
    /// Draws that into the framebuffer that is bound. The experiments may advance on another thread
    /// meanwhile. Returns the ms that it took; nothing for the first picture of new meshes, which takes
    /// longer.
    std::optional<float> draw();
    /// The same in full quality, without the window's frame or controls.
    Image image(const Traces& traces);

 private:
    struct Drawing {
        Look3d look;
        ivec2 size = ivec2(0);
        Quality quality;
        bool operator==(const Drawing&) const = default;
    };
    Quality quality(bool may_be_draft) const;
    void look(const Quality& quality, const Traces& traces);
    bool is_stereo() const { return options_.stereo && !other_is_shown_; }
    void draw_panes();

    const gl::Context& context_;
    const Session& session_;
    const Options& options_;
    ivec2 size_;
    int left_ = 0;
    Pane pane_, other_pane_;
    double moved_ = 0;             // s, when something last moved
    bool other_is_shown_ = false;  // beside the other
    bool is_due_ = false;          // a picture, since look()
    bool is_first_ = false;        // it will be the first of new meshes
    double looked_ = 0;            // s, when that was called
    double drawn_ = 0;             // the same, of the picture that was last drawn,
    Drawing drawn_as_;             // how,
    Experiment::Shapes drawn_of_;  // and of what
};

}  // namespace palpate
