#pragma once
#include "palpate/run/tip.h"
#include "palpate/touch/touch.h"

#include <memory>
#include <vector>

namespace palpate {

/// How all surfaces of a scene feel, in the order of the skins.
std::vector<Feel> feels_of(const Scene& scene);

/// Throws Error where a tool has a device that there is none of.
void check_devices(const Scene& scene);

/// A tool that is felt: a device along a scripted path, what pushes it back, and the dents that it leaves in
/// pictures (2007). Its thousand ticks a second go by the run's own clock.
class Probe {
 public:
    /// A tool of a scene, whose surfaces are the skins in its order.
    Probe(const ToolRecipe& recipe, const Scene& scene);

    bool is_there(double time) const { return within(recipe_.path, time); }

    /// Surfaces that feel another way now, as many as before; its device stays open and its motors as warm.
    void set(std::vector<Feel> feels);

    /// From `time` on, at which it is there. At the path's first time its tip is brought to the surface that
    /// it shall touch. `moving`: the skins have moved since the last call, at these velocities, m/s (one a
    /// vertex; none for a skin that stands still).
    void advance(double time, double seconds, const std::vector<Skin>& skins,
                 const std::vector<std::vector<vec3>>& velocities, bool moving);

    /// The dents in a surface at a time; without those that spring back if the tip is no longer there.
    std::vector<Dent> dents(int surface, double time) const;

    vec3 centre() const { return vec3(felt_.pose.place); }  // m
    double force() const { return force_; }                 // N, mean over the last call
    double depth() const { return depth_; }                 // m, at its end

 private:
    void begin(double time, const std::vector<Skin>& skins);
    Patch patch(double time, const std::vector<Skin>& skins,
                const std::vector<std::vector<vec3>>& velocities) const;

    ToolRecipe recipe_;
    std::string file_;  // of the scene, for messages
    std::vector<Feel> feels_;
    std::unique_ptr<Touch> touch_;
    vec3 origin_ = vec3(0);  // m, of the path
    double start_ = 0;       // s
    long ticks_ = 0;
    bool knows_surfaces_ = false;
    Felt felt_ = {};
    double force_ = 0, depth_ = 0;
};

}  // namespace palpate
