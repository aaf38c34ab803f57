#pragma once
#include "palpate/run/felt_hand.h"
#include "palpate/run/near_skins.h"

#include <memory>
#include <optional>
#include <vector>

namespace palpate {

/// How all surfaces of a scene feel, in the order of the skins.
std::vector<Feel> feels_of(const Scene& scene);

/// Throws Error if a tool names an unknown device.
void check_devices(const Scene& scene);

/// A tool that feels: a touch along a scripted path, ticked at least a thousand times a second on the run's
/// own clock. One of the kind dent leaves dents in pictures (2007); one of the kind touch presses the bodies
/// that it feels, and dents only what stands still.
class Probe {
 public:
    /// Its surfaces are the skins of the scene, in order.
    Probe(const ToolRecipe& recipe, const Scene& scene);

    bool is_there(double time) const { return within(recipe_.path, time); }
    bool presses() const { return recipe_.kind == ToolKind::touch; }

    /// Sets how the surfaces feel now; their number is the same. The device stays open, and the warmth of its
    /// motors is kept.
    void set(std::vector<Feel> feels);

    /// Says that the skins have jumped to their places instead of moved.
    void expect_jump();

    /// Advances from `time` on, when it must be present. At the path's first time its tip is placed at the
    /// surface that it shall touch. `moving`: skins may have moved since the last call.
    void advance(double time, double seconds, const std::vector<Skin>& skins, bool moving);

    /// For one that presses, in place of advance(): returns what presses the bodies from `time` on.
    /// `reaction`: N s, of the bodies to what it returned for the slice before, if that is known.
    Press press(double time, double seconds, std::optional<dvec3> reaction, const Play& play,
                const Models& models);

    /// The dents in a surface at a time; only the lasting ones if the tip is gone.
    std::vector<Dent> dents(int surface, double time) const;

    // Only after advance() or press():
    vec3 centre() const { return vec3(hand_->felt().pose.place); }  // m
    /// N: the mean of its strength since the last call.
    double take_force();
    /// m, how deep it presses.
    double depth(const std::vector<Skin>& skins) const;

 private:
    void begin(double time, const std::vector<Skin>& skins);
    void tick(double time, double seconds);

    ToolRecipe recipe_;
    std::string file_;  // of the scene, for messages
    std::vector<Feel> feels_;
    std::unique_ptr<FeltHand> hand_;
    std::vector<Skin> untouched_;  // of one that presses
    NearSkins near_;               // that it may touch
    double slice_ = 0;             // s, how long it pressed by the last call,
    dvec3 load_ = dvec3(0);        // N, and what it was pushed back with, as far as is known
    double forces_ = 0;            // N, the sum
    long ticks_ = 0;               // of so many
};

}  // namespace palpate
