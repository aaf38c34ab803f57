#pragma once
#include "palpate/viewer/orbit.h"
#include "palpate/viewer/pane.h"
#include "palpate/viewer/session.h"

namespace palpate {

/// What is open as it is seen: in one picture, or in two side by side, from where an orbit leads.
class Views {
 public:
    Views(const gl::Context& context, ivec2 size, const Session& session, const Options& options);

    Orbit orbit;

    /// So large, and so far to the right in the window.
    void resize(ivec2 size, int left);
    ivec2 size() const { return size_; }
    int left() const { return left_; }
    /// Of one of the pictures side by side.
    ivec2 view_size() const;
    /// Of one of them. Where they are narrow it sees as much across all the same.
    Camera camera() const;
    /// Of who points at a pixel; side by side the same point is in both halves.
    Sight sight(vec2 pixel) const;

    /// From where the scene itself says.
    void go_home();

    /// Something has moved, or looks otherwise.
    void wake();

    /// Into the framebuffer that is bound, as a draft where the options say so. `always`: even if nothing has
    /// moved since. Returns the ms that it took; nothing for a picture of another mesh, which takes longer.
    std::optional<float> draw(const Traces& traces, bool always, bool may_be_draft);
    /// The same in full, without a window's frame or controls.
    Image image(const Traces& traces);

 private:
    struct Drawing {
        Look3d look;
        ivec2 size = ivec2(0);
        Quality quality;
        bool operator==(const Drawing&) const = default;
    };
    Quality quality(bool may_be_draft) const;
    void draw_panes(const Quality& quality, const Traces& traces);

    const gl::Context& context_;
    const Session& session_;
    const Options& options_;
    ivec2 size_;
    int left_ = 0;
    Pane pane_, other_pane_;
    double moved_ = 0;             // s, when something last moved
    double drawn_ = 0;             // s, when the picture was last drawn,
    Drawing drawn_as_;             // how,
    Experiment::Shapes drawn_of_;  // and of what
};

}  // namespace palpate
