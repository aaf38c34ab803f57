#pragma once
#include "palpate/run/experiment.h"
#include "palpate/viewer/orbit.h"

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

}  // namespace palpate
