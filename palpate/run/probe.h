#pragma once
#include "palpate/run/felt_hand.h"

#include <memory>
#include <vector>

namespace palpate {

/// How all surfaces of a scene feel, in the order of the skins.
std::vector<Feel> feels_of(const Scene& scene);

/// Throws Error where a tool has a device that there is none of.
void check_devices(const Scene& scene);

/// A tool of a scene that is felt: a hand along a scripted path, ticked a thousand times a second by the
/// run's own clock, and the dents that it leaves in pictures (2007).
class Probe {
 public:
    /// A tool of a scene, whose surfaces are the skins in its order.
    Probe(const ToolRecipe& recipe, const Scene& scene);

    bool is_there(double time) const { return within(recipe_.path, time); }

    /// Surfaces that feel another way now, as many as before; its device stays open and its motors as warm.
    void set(std::vector<Feel> feels);

    /// The skins are where they are now without having moved there.
    void expect_jump();

    /// From `time` on, at which it is there. At the path's first time its tip is brought to the surface that
    /// it shall touch. `moving`: skins may have moved since the last call.
    void advance(double time, double seconds, const std::vector<Skin>& skins, bool moving);

    /// The dents in a surface at a time; without those that spring back if the tip is no longer there.
    std::vector<Dent> dents(int surface, double time) const;

    // Once it has been there:
    vec3 centre() const { return vec3(hand_->felt().pose.place); }  // m
    double force() const { return force_; }                         // N, mean over the last call
    double depth() const { return hand_->felt().depth; }            // m, at its end

 private:
    void begin(double time, const std::vector<Skin>& skins);

    ToolRecipe recipe_;
    std::string file_;  // of the scene, for messages
    std::vector<Feel> feels_;
    std::unique_ptr<FeltHand> hand_;
    double start_ = 0;  // s
    long ticks_ = 0;
    double force_ = 0;
};

}  // namespace palpate
