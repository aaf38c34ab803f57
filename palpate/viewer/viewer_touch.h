#pragma once
#include "palpate/run/live_touch.h"
#include "palpate/touch/drivers.h"
#include "palpate/viewer/hold.h"
#include "palpate/viewer/message.h"
#include "palpate/viewer/options.h"
#include "palpate/viewer/session.h"

#include <memory>
#include <optional>
#include <vector>

namespace palpate {

/// The viewer's hand, of the pointer or of a device: what it feels, and how it presses the bodies. It also
/// keeps the dents of the pointer's touch.
class ViewerTouch {
 public:
    explicit ViewerTouch(Message& message) : message_(message) {}

    const FeltHand* hand() const { return hand_.get(); }

    /// To be called once a picture: makes the touch that the options select, follows the pointer, and feels
    /// the surfaces there. If a device cannot be opened, a message says so, and the options are reset.
    void advance(const Experiment& experiment, Options& options, const Sight& sight);
    /// Drops the touch; the warmth of its motors is remembered.
    void drop();

    /// What the session advances by while the hand presses its bodies; nothing while it does not, or `may`
    /// not. It is dropped where it would be another session's.
    LiveTouch* live(Session& session, bool may);
    /// The same, if there is one.
    LiveTouch* live() { return live_.get(); }

    /// The view has changed.
    void look(const Sight& sight);

    // ---- the pointer's ----

    bool is_pressing() const { return pressing_; }
    /// Begins to press into the surface under the pointer. False if the touch is not the pointer's.
    bool begin_press(const Experiment& experiment, float tip, const Sight& sight);
    void deepen(const Experiment& experiment, float notches, float tip, const Sight& sight);
    void end_press(const Experiment& experiment, float tip, const Sight& sight);
    /// Whether it is at a surface, or a device moves it.
    bool is_seen() const { return hand_ && (!mouse_ || pressing_ || at_surface_); }

    /// Undoes the latest dent that still exists, if the scene has not been changed after it.
    bool can_undo(const Experiment* experiment) const { return last_dent(experiment) != nullptr; }
    void undo(const Experiment* experiment);

    // ---- the surfaces have jumped ----

    void expect_jump();
    void begin_anew();  // and have lost their dents

    /// The state of a device, for pulling with it; nothing if the touch is the pointer's.
    std::optional<Felt> device() const;
    std::optional<Arrow> arrow() const;
    void add_to(Traces& traces, std::size_t surfaces, float tip) const;

 private:
    // What the touch was made from.
    struct Kind {
        std::string device, file;
        float tip = 0;  // m
        std::vector<Feel> feels = {};
        Experiment::Shapes shapes = {};
        bool operator==(const Kind&) const = default;
    };
    // A dent that was pressed in, from the pointer's press to its release.
    struct Stroke {
        int number;           // of the touch
        std::size_t changes;  // how many changes of the scene came before it
    };
    void become(const Experiment& experiment, Options& options, const Sight& sight);
    void make(const Experiment& experiment, const Sight& sight);
    vec3 follow_pointer(const Experiment& experiment, float tip, const Sight& sight);
    const Stroke* last_dent(const Experiment* experiment) const;

    Message& message_;
    std::unique_ptr<FeltHand> hand_;
    std::unique_ptr<LiveTouch> live_;                              // of hand_
    const Experiment *lives_ = nullptr, *lives_beside_ = nullptr;  // its experiments
    Kind kind_;
    Warmth warmth_;  // of the motors of the last touch
    std::vector<Stroke> strokes_;

    Mouse* mouse_ = nullptr;       // the device of hand_, if it is one
    ivec2 looked_ = ivec2(0);      // the size of the picture that the mouse knows
    std::optional<vec2> pointed_;  // the last pixel that it was sent in this view,
    float depth_ = 0;              // m, the depth of that place before the eye,
    vec3 place_ = vec3(0);         // m, and the place
    bool at_surface_ = false;      // whether one lies there
    bool pressing_ = false;
    float rise_ = 0;  // m, of the surface above that around it, where the press began
    float push_ = 0;  // m, how deep it shall press
};

}  // namespace palpate
