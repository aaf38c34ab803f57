#pragma once
#include "palpate/run/experiment.h"
#include "palpate/touch/touch.h"
#include "palpate/viewer/orbit.h"
#include "palpate/viewer/pane.h"

#include <optional>
#include <vector>

namespace palpate {

/// One hold on a body: the user's hand grasps and pulls it.
class Hold {
 public:
    /// Grasps the free nodes within a radius of a place of a body's surface, those near it most firmly; where
    /// there are few, those around the nearest. Throws Error if the body has none.
    static Hold pulling(const Experiment& experiment, const Hit& hit, float radius);

    vec3 place() const { return place_; }  // m, of the hand
    std::size_t body() const { return body_; }

    /// It is there at once.
    void put(vec3 place) { place_ = target_ = place; }
    /// Its springs while it is there.
    std::vector<BodyPush> pulls_at(vec3 place) const;

    /// Sets its target. It moves there no faster than a person would.
    void go_to(vec3 place) { target_ = place; }
    vec3 target() const { return target_; }

    /// Adds its action in the next frame, and moves it.
    void add_to(Interaction& hands);

    /// The reaction force on it in the last frame, N, if `first` is the index of its first pull there.
    dvec3 force(const InteractionForces& pushes, std::size_t first) const;
    std::size_t pulls() const { return threads_.size(); }

    /// The mean place of the nodes that it holds.
    vec3 held(const Play& play) const;

    /// Whether its nodes still exist.
    bool fits(const Experiment& experiment) const;

 private:
    // A spring to one node, which pulls it to an offset from the hand.
    struct Thread {
        int node;
        vec3 offset;      // m
        float stiffness;  // N/m
    };

    std::size_t body_ = 0, nodes_ = 0;
    std::vector<Thread> threads_;
    float fastest_ = 1;  // m/s
    vec3 place_ = vec3(0), target_ = vec3(0);
};

/// A force to be shown, and where it acts.
struct Arrow {
    vec3 at = vec3(0);     // m
    vec3 force = vec3(0);  // N
};

/// All holds: those that were left in place, the pointer's own, and a device's.
class Holds {
 public:
    /// All, in that order.
    std::vector<Hold> all() const;

    bool has_own() const { return own_.has_value(); }
    /// Sets the pointer's own hold, and its depth in the picture.
    void take(const Hold& hold, const Sight& sight);
    /// Moves it with the pointer, at the same depth; or deeper, m.
    void follow(const Sight& sight);
    void deepen(float by) { depth_ += by; }
    void leave();    // it stays in place
    void release();  // it ends
    void clear();    // all end

    /// Ends those whose nodes no longer exist.
    void keep_fitting(const Experiment& experiment);

    /// Lets a device other than a mouse pull: it grasps what it touches, as long as its first button is
    /// pressed. Without `felt` it does not.
    void follow(const Experiment& experiment, const std::optional<Felt>& felt, float tip);
    const std::optional<Hold>& of_device() const { return device_; }

    /// Adds their actions in the next frame, without the device's.
    void add_to(Interaction& hands);

    std::vector<Arrow> arrows(const InteractionForces& pushes) const;
    void add_to(Traces& traces, const Play& play, float tip) const;

 private:
    std::vector<Hold> left_;
    std::optional<Hold> own_, device_;
    float depth_ = 0;  // m before the eye, of the pointer's own
};

}  // namespace palpate
