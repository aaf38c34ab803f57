#pragma once
#include "palpate/body/influences.h"
#include "palpate/scene/build.h"
#include "palpate/solver/world.h"

#include <optional>
#include <vector>

namespace palpate {

/// A tool that grasps one node and drags it along a scripted path; at the path's end it releases it.
class Grip {
 public:
    explicit Grip(const ToolRecipe& recipe) : recipe_(recipe) {}

    /// The action for the frame from `time` on, or none while the tool is absent. At the path's first time it
    /// grasps the nearest free node. Throws Error if there is none.
    std::optional<NodePush> drag(double time, double frame, const std::vector<Model>& models,
                                 const World& world);

    /// The index of the body that it holds.
    std::size_t body() const { return body_; }

    /// The point to which it pulls at a time within its path, m.
    vec3 centre(double time) const { return origin_ + position(recipe_.path, time); }

 private:
    void take_hold(const std::vector<Model>& models, const World& world);

    ToolRecipe recipe_;
    std::size_t body_ = 0;
    int node_ = -1;
    vec3 origin_ = vec3(0);  // of the path
};

}  // namespace palpate
