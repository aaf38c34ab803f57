#pragma once
#include "palpate/viewer/feeling_hand.h"
#include "palpate/viewer/readings.h"
#include "palpate/viewer/saving.h"
#include "palpate/viewer/session.h"
#include "palpate/viewer/views.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

enum class Button { left, middle, right };

/// What the window shows and what a pointer does in it, without a window: whoever has one, or a test, tells
/// it of events, lets it go on, and asks it to draw. All in one thread.
class Viewer {
 public:
    /// Draws in that context, which must outlive it.
    Viewer(const gl::Context& context, ivec2 size)
        : session_(context, message_), views_(context, size, session_, options) {}

    Options options;
    std::filesystem::path folder = ".";  // where what is saved goes

    // ---- what is open ----

    /// Begins to build a scene, and shows it when it is ready; until then what was open goes on.
    void open(SceneText source, std::vector<Change> changes = {}) {
        session_.open(std::move(source), std::move(changes));
    }
    /// A scene, a mesh, a volume or a recording. What cannot be opened is said in message().
    void open_file(const std::filesystem::path& file) noexcept;
    void replay(Recording recording) { session_.replay(std::move(recording)); }
    /// Shows at once what was built. Throws Error, and what was open stays.
    void begin(Prepared prepared);
    void cancel_import() { session_.cancel_import(); }
    const Import* importing() const { return session_.importing(); }
    Experiment* experiment() { return session_.experiment(); }
    const Experiment* experiment() const { return session_.experiment(); }
    const Experiment* beside() const { return session_.beside(); }
    bool replaying() const { return session_.replaying(); }

    // ---- what a person does; places in pixels from the window's upper left corner ----

    /// The picture is as large, and begins so far to the right in the window, beside its controls.
    void resize(ivec2 size, int left = 0) { views_.resize(size, left); }
    void move_pointer(vec2 pixel);
    void press(Button button, bool shift = false, bool alt = false);
    void release(Button button);
    void wheel(float notches);
    /// What it holds stays there, or if it holds nothing, all that was left goes.
    void keep();
    void frame_selection();
    void reset_camera();
    void pause() { options.paused = !options.paused; }
    void step_once();
    void restart();
    /// The latest change of the scene, or the latest dent that stayed.
    void undo();
    bool can_undo() const;
    void redo();
    void return_to_good();
    /// Changes of the scene. What cannot be is said in message(), and nothing changes.
    void change(const std::vector<Change>& changes, bool again = false);

    void save(Output what);
    bool filming() const { return saving_.is_filming(); }

    // ---- going on ----

    /// So many frames of 1/60 s, if it is not paused; and whatever has become ready meanwhile.
    void advance(int frames);
    /// Into the framebuffer that is bound.
    void draw();
    /// What is drawn, as it would be without a draft's haste, and without a window's frame or controls.
    Image image();

    // ---- to show ----

    ivec2 size() const { return views_.size(); }
    int left() const { return views_.left(); }
    ivec2 view_size() const { return views_.view_size(); }
    Camera camera() const { return views_.camera(); }
    const Message& message() const { return message_; }
    std::vector<Arrow> arrows() const;
    std::vector<Hold> holds() const { return holds_.all(); }
    bool is_holding() const { return holds_.has_own() || feeling_.is_denting(); }
    bool touched() const { return touched_; }  // whether anybody has reached in yet
    const FeltHand* feeling() const { return feeling_.hand(); }
    const Readings& readings() const { return readings_; }

 private:
    enum class Drag { none, turn, pan, hold };

    Sight sight() const { return views_.sight(pointer_); }
    void reach_in();
    void pull_or_press(const Hit& hit);
    void pin_at(const Hit& hit);
    void turned();
    void let_go();
    void alter(const std::function<void()>& how, const std::string& said = {});
    void one_frame();
    Traces traces() const;

    Message message_;
    Session session_;
    Views views_;
    Holds holds_;
    FeelingHand feeling_{message_};
    Saving saving_{message_};
    Readings readings_;

    vec2 pointer_ = vec2(0);
    Drag drag_ = Drag::none;
    Button drag_button_ = Button::left;  // that it goes on with
    bool touched_ = false;
    std::vector<vec3> selected_;  // m, around what was last taken hold of
};

}  // namespace palpate
