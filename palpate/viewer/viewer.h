#pragma once
#include "palpate/viewer/readings.h"
#include "palpate/viewer/saving.h"
#include "palpate/viewer/session.h"
#include "palpate/viewer/viewer_touch.h"
#include "palpate/viewer/views.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

enum class Button { left, middle, right };

/// The content of the viewer's window without the window: a window or a test sends it events, advances it,
/// and lets it draw. All on one thread.
class Viewer {
 public:
    /// `context`: for drawing; it must outlive the viewer.
    Viewer(const gl::Context& context, ivec2 size)
        : session_(context, message_), views_(context, size, session_, options) {}

    Options options;
    std::filesystem::path folder = ".";  // where outputs are saved

    // ---- what is open ----

    /// Begins to build a scene, and shows it when it is ready; until then the one that is open continues.
    void open(SceneText source, std::vector<Change> changes = {}) {
        session_.open(std::move(source), std::move(changes));
    }
    /// Opens a scene, a mesh, a volume or a recording. If that fails, message() says why.
    void open_file(const std::filesystem::path& file) noexcept;
    void replay(Recording recording) { session_.replay(std::move(recording)); }
    /// Shows a built scene at once. Throws Error; then nothing has changed.
    void begin(Prepared prepared);
    void cancel_import() { session_.cancel_import(); }
    const Import* importing() const { return session_.importing(); }
    Experiment* experiment() { return session_.experiment(); }
    const Experiment* experiment() const { return session_.experiment(); }
    const Experiment* beside() const { return session_.beside(); }
    bool replaying() const { return session_.replaying(); }

    // ---- user input; positions are in pixels from the window's upper left corner ----

    /// Sets the size of the picture, and how far to the right it begins, beside the controls.
    void resize(ivec2 size, int left = 0) { views_.resize(size, left); }
    void move_pointer(vec2 pixel);
    void press(Button button, bool shift = false, bool alt = false);
    void release(Button button);
    void wheel(float notches);
    /// Leaves the present hold in place; without one, ends all that were left.
    void keep();
    void frame_selection();
    void reset_camera();
    void pause() { options.paused = !options.paused; }
    void step_once();
    void restart();
    /// Undoes the latest change of the scene, or the latest lasting dent.
    void undo();
    bool can_undo() const;
    void redo();
    void return_to_good();
    /// Changes the scene. If that fails, message() says why, and nothing changes.
    void change(const std::vector<Change>& changes, bool again = false);

    void save(Output what);
    bool filming() const { return saving_.is_filming(); }

    // ---- advancing ----

    /// Advances by frames of 1/60 s, unless paused or go_on() did that; and takes what has been built
    /// meanwhile.
    void advance(int frames);
    /// Takes a copy of what shall be drawn,
    void look();
    /// and draws it into the framebuffer that is bound.
    void draw();

    /// While a hand presses bodies, they advance on a thread of their own from here to hold_still(). In
    /// between, only draw() may be called, and what does not look at the experiment.
    void go_on();
    void hold_still();
    bool is_live() const { return live_; }  // in between
    /// The picture in full quality, without the window's frame or controls.
    Image image();

    // ---- for drawing ----

    ivec2 size() const { return views_.size(); }
    int left() const { return views_.left(); }
    ivec2 view_size() const { return views_.view_size(); }
    Camera camera() const { return views_.camera(); }
    const Message& message() const { return message_; }
    std::vector<Arrow> arrows() const;
    std::vector<Hold> holds() const { return holds_.all(); }
    bool is_holding() const { return holds_.has_own() || feeling_.is_pressing(); }
    bool touched() const { return touched_; }  // whether the user has interacted yet
    const FeltHand* feeling() const { return feeling_.hand(); }
    bool shows_tip() const { return feeling_.is_seen() && !holds_.has_own(); }
    const Readings& readings() const { return readings_; }

 private:
    enum class Drag { none, turn, pan, hold };

    Sight sight() const { return views_.sight(pointer_); }
    void reach_in(bool pulls);
    bool may_be_live() const;
    void pin_at(const Hit& hit);
    void turned();
    void let_go();
    void alter(const std::function<void()>& how, const std::string& said = {});
    void one_frame();
    Interaction hands();
    void hand_over_to(LiveTouch& live);
    Traces traces() const;

    Message message_;
    Session session_;
    Views views_;
    Holds holds_;
    ViewerTouch feeling_{message_};
    Saving saving_{message_};
    Readings readings_;

    vec2 pointer_ = vec2(0);
    Drag drag_ = Drag::none;
    Button drag_button_ = Button::left;  // the button that began it
    bool touched_ = false;
    std::vector<vec3> selected_;  // m, around what was last grasped
    bool live_ = false;           // on a thread of its own
    bool went_on_ = false;        // likewise, since the last advance()
};

}  // namespace palpate
