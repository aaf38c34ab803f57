#pragma once
#include "palpate/body/influences.h"
#include "palpate/run/tip.h"
#include "palpate/touch/loop.h"

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace palpate {

/// A Touch on the skins of a play. It is ticked in real time by a servo loop of its own (go_live()), or by
/// its owner on another clock (tick()), as for films.
class FeltHand {
 public:
    /// `start`: about where the device is at first, m. Throws Error if the device cannot be opened. `warmth`:
    /// of motors that were used before.
    FeltHand(std::unique_ptr<Device> device, TouchSettings settings, vec3 start, const Warmth& warmth = {});

    /// Sets what it can touch from `time` on: the skins within `reach` of it, as they lie then, with
    /// velocities from the last call on. `reach`: m, more than it moves until the next call. `moved_for`: s,
    /// of the surfaces' own time since the last call, if that is not the difference of `time`.
    void feel(const std::vector<Skin>& skins, double time,
              float reach = std::numeric_limits<float>::infinity(), const Simulated& simulated = {},
              std::optional<double> moved_for = {});

    /// Says that the skins of the next feel() have jumped instead of moved, or have other vertices: ...
    void expect_jump() {
        before_.clear();
        maker_.forget();
        pressed_from_.reset();
        jumps_ = true;
    }
    /// Says where they were at the last feel(), since the next has other vertices.
    void remember(std::vector<std::vector<vec3>> before) {
        if (!jumps_) before_ = std::move(before);
    }
    /// ... and were replaced or reset: dents are removed, and it begins without force.
    void begin_anew();

    void go_live() { loop_.emplace(std::vector<Touch*>{&touch_}); }
    void tick(double now);

    /// What presses the bodies that it feels, during the next `seconds`: a ball of the tip's size, on its way
    /// from its place() at the last call to that after the last feel() or tick(). It presses them, the first
    /// `bodies` of the surfaces, with the stiffness, friction and damping of the one that it touches deepest;
    /// of the stiffest, if it touches something else deeper.
    Press press(double seconds, std::size_t bodies);

    /// The state at the last feel() or tick(), so that everything in a picture shows the same moment.
    const Felt& felt() const { return felt_; }
    /// Where the device is, m; but no deeper in a surface than 1.2 radii, or the ball would fall through.
    vec3 place() const;
    float radius() const { return float(touch_.settings().radius); }  // m, of its tip
    Touch& touch() { return touch_; }
    bool is_live() const { return loop_.has_value(); }
    /// Only if it is live.
    const TouchLoop& loop() const { return *loop_; }

 private:
    Touch touch_;
    Felt felt_ = {};
    vec3 start_;
    std::optional<vec3> pressed_from_;  // m
    unsigned placed_ = 0;               // Felt::placed then
    bool begins_anew_ = false, jumps_ = false;
    PatchMaker maker_;
    std::vector<std::vector<vec3>> before_;  // the last positions of the skins,
    double before_time_ = 0;                 // s, and their time
    std::vector<std::vector<vec3>> speeds_;  // since the positions before them, m/s
    std::optional<TouchLoop> loop_;          // destroyed first, because it ticks the touch
};

}  // namespace palpate
