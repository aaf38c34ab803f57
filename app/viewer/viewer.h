#pragma once
#include "app/viewer/hand.h"
#include "app/viewer/import.h"
#include "app/viewer/orbit.h"
#include "app/viewer/pane.h"
#include "palpate/run/experiment.h"
#include "palpate/run/felt_hand.h"
#include "palpate/run/film.h"
#include "palpate/touch/drivers.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// The last few seconds of something that is measured once a picture.
class Recent {
 public:
    static constexpr std::size_t length = 180;
    void add(float value) {
        values_[next_] = value;
        next_ = (next_ + 1) % length;
        count_ = std::min(count_ + 1, length);
    }
    std::size_t count() const { return count_; }
    float at(std::size_t i) const {
        return values_[(next_ + length - count_ + i) % length];
    }  // the oldest: 0
    float mean() const;
    float most() const;

 private:
    std::array<float, length> values_ = {};
    std::size_t next_ = 0, count_ = 0;
};

/// The same experiment twice, side by side: the right one with another mapping, or on another backend.
struct Compared {
    enum class With { nothing, mapping, backend } with = With::nothing;
    Mapping mapping = Mapping::trilinear;
    Backend backend = Backend::reference;
    bool operator==(const Compared&) const = default;
};

/// How well pictures are drawn.
enum class Care {
    automatic,  // as a draft until it is paused, where the CPU has to draw; else in full
    draft,
    full
};

/// All that a person can set about how they look and reach in; it is no part of what moves.
struct Options {
    Mode mode = Mode::pull;
    float tip = 0.01f;  // m, the radius of what presses and dents
    Look3d look;
    Care care = Care::automatic;
    bool paused = false;
    bool stereo = false;  // side by side, for the papers' immersive displays
    Compared compared;
    std::string device = "mouse";  // the name of its driver
    std::string device_file;       // its path, or its log
};

enum class Button { left, middle, right };

/// What the window shows and what a pointer does in it, without a window: whoever has one, or a test, tells
/// it of events, lets it go on, and asks it to draw. All in one thread.
class Viewer {
 public:
    /// Draws in that context, which must outlive it.
    Viewer(const gl::Context& context, ivec2 size);
    ~Viewer();

    Options options;

    // ---- what is open ----

    /// Begins to build a scene, and shows it when it is ready; until then what was open goes on.
    void open(SceneText source, std::vector<Change> changes = {});
    /// A scene, a mesh, a volume or a recording. What cannot be opened is said in message().
    void open_file(const std::filesystem::path& file) noexcept;
    void replay(Recording recording);
    const Import* importing() const { return import_.get(); }
    void cancel_import();
    Experiment* experiment() { return experiment_.get(); }
    const Experiment* experiment() const { return experiment_.get(); }
    const Experiment* beside() const { return beside_.get(); }
    bool replaying() const { return bool(replay_); }

    // ---- what a person does; places in pixels from the window's upper left corner ----

    /// The picture is as large, and begins so far to the right in the window, beside its controls.
    void resize(ivec2 size, int left = 0);
    ivec2 size() const { return size_; }
    int left() const { return left_; }
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
    bool can_undo() const { return last_dent() || (experiment_ && experiment_->can_undo()); }
    void redo();
    void return_to_good();
    /// Changes of the scene. What cannot be is said in message(), and nothing changes.
    void change(const std::vector<Change>& changes, bool again = false);

    void save_scene();
    void save_picture();
    void save_surface();
    void save_recording();
    void start_or_stop_film();
    bool filming() const { return bool(film_); }
    std::filesystem::path folder = ".";  // where all that goes

    // ---- going on ----

    /// So many frames of 1/60 s, if it is not paused; and whatever has become ready meanwhile.
    void advance(int frames);
    /// Into the framebuffer that is bound.
    void draw();
    /// What is drawn, as it would be without a draft's haste, and without a window's frame or controls.
    Image image();

    // ---- to show ----

    /// Of one of the pictures side by side. Where those are narrow it sees as much across all the same.
    Camera camera() const;
    struct Message {
        std::string text;
        bool bad = false;
        double since = 0;  // s
    };
    const Message& message() const { return message_; }
    /// A force on a hand, where it is.
    struct Arrow {
        vec3 at = vec3(0);     // m
        vec3 force = vec3(0);  // N
    };
    std::vector<Arrow> arrows() const;
    /// The pointer's own, those that were left, and a device's.
    std::vector<Hold> holds() const;
    bool is_holding() const { return active_.has_value() || denting_; }
    bool touched() const { return touched_; }  // whether anybody has reached in yet
    const FeltHand* feeling() const { return feeling_.get(); }
    ivec2 view_size() const;  // of one of the pictures side by side
    struct Readings {
        Recent simulate, map, draw;    // ms a picture
        Recent pace;                   // s of the scene a second
        std::optional<Energy> energy;  // none where that would have to be read from a GPU
        double largest_speed = 0;      // m/s
        std::size_t memory = 0;        // bytes, of all moving states
    };
    const Readings& readings() const { return readings_; }

 private:
    enum class Drag { none, turn, pan, hold };
    struct HandSettings {
        std::string device;
        std::string file;
        float tip = 0;  // m
        std::vector<Feel> feels = {};
        int shapes = 0;  // of the experiment
        bool operator==(const HandSettings&) const = default;
    };
    // A dent that was pressed in, from the pointer's press to its release.
    struct Stroke {
        int number;           // of the hand that feels
        std::size_t changes;  // how many of the scene came before it
    };
    struct Drawing {
        Look3d look;
        ivec2 size = ivec2(0);
        Quality quality;
        bool operator==(const Drawing&) const = default;
    };

    void begin(Prepared prepared);
    void say(const std::string& text, bool bad = false);
    bool attempt(const std::function<void()>& what) noexcept;
    void take_import();
    void follow_compared();
    void reach_in();
    void pin_at(const Hit& hit);
    void start_denting();
    void look_with_mouse();
    vec3 follow_pointer();  // where the hand is then
    void make_feeling_hand();
    void drop_feeling_hand();
    const Stroke* last_dent() const;
    void follow_device();
    void feel();
    void one_frame();
    void replay_frame();
    void live_frame();
    void add_film_frame();
    Traces traces() const;
    Quality quality() const;
    bool room_for(const Hold& hold) const;
    std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& ending) const;
    void let_go();
    void alter(const std::function<void()>& how, const std::string& said = {});
    void finish_film();
    bool is_drawn(const Drawing& as) const;
    void measure(double seconds);
    void draw_views(const Quality& quality);

    const gl::Context& context_;
    ivec2 size_;
    int left_ = 0;
    Pane pane_, other_pane_;
    std::unique_ptr<Import> import_;
    std::unique_ptr<Experiment> experiment_, beside_;
    Compared compared_;  // what beside_ is
    std::optional<Recording> replay_,
        coming_;  // what is replayed; what the scene that is being opened is for
    Orbit orbit_;
    Message message_;

    vec2 pointer_ = vec2(0);
    Drag drag_ = Drag::none;
    Button drag_button_ = Button::left;  // that it goes on with
    std::vector<Hold> holds_;
    std::optional<std::size_t> active_;  // of the holds, the pointer's own
    std::optional<Hold> device_hold_;    // of a device that is no mouse
    float depth_ = 0;                    // m from the eye, of what the pointer holds
    std::unique_ptr<FeltHand> feeling_;
    Mouse* mouse_ = nullptr;   // feeling_'s, if that is its device
    HandSettings feeling_of_;  // what feeling_ was made of
    Warmth warmth_;            // of the motors of the one before
    std::vector<Stroke> strokes_;
    std::optional<vec2> pointed_;  // the pixel that mouse_ was told of in this view
    ivec2 looked_ = ivec2(0);      // the size of the picture that mouse_ knows
    bool denting_ = false, touched_ = false;
    float push_ = 0;              // m, how deep the pointer dents
    float mouse_depth_ = 0;       // m from the eye, along the view, of where mouse_ was told to be,
    vec3 mouse_place_ = vec3(0);  // m, and that place
    std::vector<vec3> selected_;  // m, around what was last taken hold of

    std::unique_ptr<Film> film_;
    ivec2 film_size_ = ivec2(0);  // of its pictures
    std::filesystem::path film_name_;
    long frames_ = 0;   // since it was opened
    double moved_ = 0;  // s, when something last moved
    int shapes_shown_ = -1;
    double drawn_ = 0;  // s, when the picture was last drawn,
    Drawing drawn_as_;  // and how
    Readings readings_;
    double simulated_before_ = 0, mapped_before_ = 0, measured_ = 0, paced_ = 0;
};

}  // namespace palpate
