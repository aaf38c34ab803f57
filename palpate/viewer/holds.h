#pragma once
#include "palpate/touch/touch.h"
#include "palpate/viewer/hand.h"
#include "palpate/viewer/options.h"
#include "palpate/viewer/pane.h"

#include <optional>
#include <vector>

namespace palpate {

/// A force on a hand, where it is.
struct Arrow {
    vec3 at = vec3(0);     // m
    vec3 force = vec3(0);  // N
};

/// The hands that pull and press: those that were left, the pointer's own, and a device's.
class Holds {
 public:
    /// In that order.
    std::vector<Hold> all() const;

    bool has_own() const { return own_.has_value(); }
    /// The pointer's, and how deep in the picture it is. False if no more hands fit on the bodies.
    bool take(const Experiment& experiment, const Hold& hold, const Sight& sight);
    /// It goes along with the pointer, as deep as it is; or deeper, m.
    void follow(const Sight& sight);
    void deepen(float by) { depth_ += by; }
    void leave();    // it stays where it is
    void release();  // it lets go
    void clear();    // all let go

    /// Without those whose bodies are others now.
    void keep_fitting(const Experiment& experiment);

    /// A device that is no mouse pulls or presses, wherever it is: it takes hold of what it touches until its
    /// first button is pressed. Nothing felt: it does neither.
    void follow(const Experiment& experiment, const std::optional<Felt>& felt, const Options& options);

    /// What they do in the coming frame.
    void add_to(Hands& hands);

    std::vector<Arrow> arrows(const Pushes& pushes) const;
    void add_to(Traces& traces, const Play& play, float tip) const;

 private:
    bool room_for(const Experiment& experiment, const Hold& hold) const;

    std::vector<Hold> left_;
    std::optional<Hold> own_, device_;
    float depth_ = 0;  // m before the eye, of the pointer's own
};

}  // namespace palpate
