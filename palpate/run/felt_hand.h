#pragma once
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
    /// velocities from the last call on. `reach`: m, more than it moves until the next call.
    void feel(const std::vector<Skin>& skins, double time,
              float reach = std::numeric_limits<float>::infinity(), const Simulated& simulated = {});

    /// Says that the skins of the next feel() have jumped instead of moved: ...
    void expect_jump() { before_.clear(); }
    /// ... and were replaced or reset: dents are removed, and it begins without force.
    void begin_anew();

    void go_live() { loop_.emplace(std::vector<Touch*>{&touch_}); }
    void tick(double now);

    /// The state at the last feel() or tick(), so that everything in a picture shows the same moment.
    const Felt& felt() const { return felt_; }
    vec3 start() const { return start_; }  // m
    Touch& touch() { return touch_; }
    /// Only if it is live.
    const TouchLoop& loop() const { return *loop_; }

 private:
    Touch touch_;
    Felt felt_ = {};
    vec3 start_;
    bool begins_anew_ = false;
    PatchMaker maker_;
    std::vector<std::vector<vec3>> before_;  // the last positions of the skins,
    double before_time_ = 0;                 // s, and their time
    std::vector<std::vector<vec3>> speeds_;  // since the positions before them, m/s
    std::optional<TouchLoop> loop_;          // destroyed first, because it ticks the touch
};

}  // namespace palpate
