#pragma once
#include "palpate/run/experiment.h"
#include "palpate/touch/touch.h"
#include "palpate/viewer/options.h"
#include "palpate/viewer/orbit.h"
#include "palpate/viewer/pane.h"

#include <optional>
#include <vector>

namespace palpate {

/// A hand that has hold of a body, or a tip of it that presses.
class Hold {
 public:
    /// Takes hold of the free nodes around a place of a body's surface. Throws Error if there are none near.
    static Hold pulling(const Experiment& experiment, const Hit& hit);

    /// A tip that comes along a line of sight, touches what `hit` says and goes in by half its radius.
    static Hold pressing(const Experiment& experiment, const Hit& hit, const Ray& ray, float radius);

    /// A tip somewhere, as strong as suits that body.
    static Hold tip(const Experiment& experiment, std::size_t body, vec3 place, float radius);

    bool presses() const { return threads_.empty(); }
    float radius() const { return radius_; }
    vec3 place() const { return place_; }  // m, of the hand
    std::size_t body() const { return body_; }

    /// Where it shall go. It goes there no faster than a person would move it.
    void go_to(vec3 place) { target_ = place; }
    vec3 target() const { return target_; }

    /// What it does in the coming frame, at whose end it is where it then goes.
    void add_to(Hands& hands);

    /// The force on it in the last frame, N, if `first` is the number of its press or of its first pull then.
    dvec3 force(const Pushes& pushes, std::size_t first) const;
    std::size_t pulls() const { return threads_.size(); }

    /// Where the surface is that it pulls: at its nodes.
    vec3 held(const Play& play) const;

    /// Whether its nodes are still those of a body.
    bool fits(const Experiment& experiment) const;

 private:
    // A node on its way, how far off the hand it is to be, and how strongly.
    struct Thread {
        int node;
        vec3 offset;      // m
        float stiffness;  // N/m
    };

    std::size_t body_ = 0, nodes_ = 0;
    std::vector<Thread> threads_;
    float radius_ = 0;     // m, of a tip
    float stiffness_ = 0;  // N/m, of a tip
    float fastest_ = 1;    // m/s
    vec3 place_ = vec3(0), target_ = vec3(0);
};

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
    /// The pointer's, and how deep in the picture it is.
    void take(const Hold& hold, const Sight& sight);
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
    std::vector<Hold> left_;
    std::optional<Hold> own_, device_;
    float depth_ = 0;  // m before the eye, of the pointer's own
};

}  // namespace palpate
