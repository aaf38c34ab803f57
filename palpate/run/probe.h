#pragma once
#include "palpate/run/felt_hand.h"

#include <memory>
#include <vector>

namespace palpate {

/// How all surfaces of a scene feel, in the order of the skins.
std::vector<Feel> feels_of(const Scene& scene);

/// Throws Error if a tool names an unknown device.
void check_devices(const Scene& scene);

/// A tool of the kind dent: a touch along a scripted path, ticked a thousand times a second on the run's own
/// clock, with the dents that it leaves in pictures (2007).
class Probe {
 public:
    /// Its surfaces are the skins of the scene, in order.
    Probe(const ToolRecipe& recipe, const Scene& scene);

    bool is_there(double time) const { return within(recipe_.path, time); }

    /// Sets how the surfaces feel now; their number is the same. The device stays open, and the warmth of its
    /// motors is kept.
    void set(std::vector<Feel> feels);

    /// Says that the skins have jumped to their places instead of moved.
    void expect_jump();

    /// Advances from `time` on, when it must be present. At the path's first time its tip is placed at the
    /// surface that it shall touch. `moving`: skins may have moved since the last call.
    void advance(double time, double seconds, const std::vector<Skin>& skins, bool moving);

    /// The dents in a surface at a time; only the lasting ones if the tip is gone.
    std::vector<Dent> dents(int surface, double time) const;

    // Only after advance():
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
