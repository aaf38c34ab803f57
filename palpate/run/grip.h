#pragma once
#include "palpate/body/influences.h"
#include "palpate/scene/build.h"
#include "palpate/solver/world.h"

#include <optional>
#include <vector>

namespace palpate {

/// A tool that takes hold of one node and drags it along a scripted path; at the path's end it lets go.
class Grip {
 public:
    explicit Grip(const ToolRecipe& recipe) : recipe_(recipe) {}

    /// The push for the frame from `time` on, or none while the tool is away. At the path's first time it
    /// takes hold of the nearest node that can move. Throws Error if there is none.
    std::optional<NodePush> drag(double time, double frame, const std::vector<Model>& models,
                                 const World& world);

    /// The number of the body that it has hold of.
    std::size_t body() const { return body_; }

    /// Where it pulls to at a time within its path, m.
    vec3 centre(double time) const { return origin_ + position(recipe_.path, time); }

 private:
    void take_hold(const std::vector<Model>& models, const World& world);

    ToolRecipe recipe_;
    std::size_t body_ = 0;
    int node_ = -1;
    vec3 origin_ = vec3(0);  // of the path
};

}  // namespace palpate
