#pragma once
#include "palpate/run/felt_hand.h"
#include "palpate/touch/drivers.h"
#include "palpate/viewer/hand.h"
#include "palpate/viewer/message.h"

#include <memory>
#include <optional>
#include <vector>

namespace palpate {

/// The hand that feels while there is one: the pointer's where it dents, or a device's; and the dents that
/// the pointer's left.
class FeelingHand {
 public:
    explicit FeelingHand(Message& message) : message_(message) {}

    const FeltHand* hand() const { return hand_.get(); }

    /// Once a picture: becomes what the options ask for, follows the pointer and feels what lies there. Where
    /// a device cannot be opened, that is said, and the options ask for it no more.
    void advance(const Experiment& experiment, Options& options, const Sight& sight);
    /// Its motors cool down while there is none.
    void drop();

    /// Another view of the same.
    void look(const Sight& sight);

    // ---- the pointer's ----

    bool is_denting() const { return denting_; }
    /// It goes into the surface under the pointer. False if it is not the pointer's.
    bool begin_dent(const Experiment& experiment, float tip, const Sight& sight);
    void deepen(const Experiment& experiment, float notches, float tip, const Sight& sight);
    void end_dent(const Experiment& experiment, float tip, const Sight& sight);

    /// The latest dent that is still there, if no change of the scene came after it.
    bool can_undo(const Experiment* experiment) const { return last_dent(experiment) != nullptr; }
    void undo(const Experiment* experiment);

    // ---- the surfaces are at once where they are now ----

    void expect_jump();
    void begin_anew();  // and have no dents

    /// What it says to whoever pulls or presses by it; nothing where it is the pointer's.
    std::optional<Felt> device(const Experiment& experiment, const Options& options) const;
    std::optional<Arrow> arrow() const;
    void add_to(Traces& traces, std::size_t surfaces, float tip) const;

 private:
    // What it was made of.
    struct Kind {
        std::string device, file;
        float tip = 0;  // m
        std::vector<Feel> feels = {};
        Experiment::Shapes shapes = {};
        bool operator==(const Kind&) const = default;
    };
    // A dent that was pressed in, from the pointer's press to its release.
    struct Stroke {
        int number;           // of the hand that feels
        std::size_t changes;  // how many of the scene came before it
    };
    void become(const Experiment& experiment, Options& options, const Sight& sight);
    void make(const Experiment& experiment, const Sight& sight);
    vec3 follow_pointer(const Experiment& experiment, float tip, const Sight& sight);
    const Stroke* last_dent(const Experiment* experiment) const;

    Message& message_;
    std::unique_ptr<FeltHand> hand_;
    Kind kind_;
    Warmth warmth_;  // of the motors of the one before
    std::vector<Stroke> strokes_;

    Mouse* mouse_ = nullptr;       // hand_'s, if that is its device
    ivec2 looked_ = ivec2(0);      // the size of the picture that it knows
    std::optional<vec2> pointed_;  // the pixel that it was told of in this view,
    float depth_ = 0;              // m from the eye, along the view, of where it was told to be,
    vec3 place_ = vec3(0);         // m, and that place
    bool denting_ = false;
    float push_ = 0;  // m, how deep it dents
};

}  // namespace palpate
