#pragma once
#include "palpate/run/tip.h"
#include "palpate/touch/loop.h"

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace palpate {

/// A person's hand among the skins of a play, and what it feels. It is ticked in real time by a loop of its
/// own (go_live()), or else by whoever has another clock (tick()), as films do.
class FeltHand {
 public:
    /// Near `start`, m. Throws Error if the device cannot be opened. `warmth`: of motors that were used
    /// before.
    FeltHand(std::unique_ptr<Device> device, TouchSettings settings, vec3 start, const Warmth& warmth = {});

    /// What it can meet from `time` on: the skins within `reach` of it, as they lie then, going on as they
    /// have gone since the last call. `reach`: m, farther than it goes before the next call.
    void feel(const std::vector<Skin>& skins, double time,
              float reach = std::numeric_limits<float>::infinity());

    /// The skins of the next feel() have not moved to where they are, but are there at once: ...
    void expect_jump() { before_.clear(); }
    /// ... and are others, or as at the start: no dent stays, and the hand begins without force.
    void begin_anew();

    void go_live() { loop_.emplace(std::vector<Touch*>{&touch_}); }
    void tick(double now);

    /// As it was at the last feel() or tick(), so that all of a picture shows the same moment.
    const Felt& felt() const { return felt_; }
    Touch& touch() { return touch_; }
    /// Of one that is live.
    const TouchLoop& loop() const { return *loop_; }

 private:
    Touch touch_;
    Felt felt_ = {};
    vec3 start_;
    bool begins_anew_ = false;
    std::vector<std::vector<vec3>> before_;  // where the skins were,
    double before_time_ = 0;                 // s, and when that was
    std::optional<TouchLoop> loop_;          // last: it ticks the touch
};

}  // namespace palpate
