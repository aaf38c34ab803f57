#pragma once
#include "palpate/gl/field.h"
#include "palpate/solver/guides.h"
#include "palpate/solver/pass.h"
#include "palpate/solver_gl/pipeline.h"
#include "palpate/solver_gl/placement.h"

#include <optional>
#include <span>
#include <vector>

namespace palpate::gpu {

/// What acts on a body besides colliders and wind.
enum class Tools {
    none,
    pushing,    // tips that only push, and pushes of nodes
    resisting,  // and tips with friction or a damper
};

/// The physics of a body as GLSL, with or without tools. What cannot act is left out: a software driver runs
/// both sides of every branch.
Text physics(const Body& body, const Simulation& simulation, const Placement& placement, int width,
             Tools tools, bool tiled);

/// All that nodes look at besides the moving state: what they are made of, the pass, guides and obstacles.
class BodyOnGpu {
 public:
    BodyOnGpu(const Body& body, const Simulation& simulation, const Placement& placement);

    /// These nodes' springs and outsides are others now. False, and nothing has changed, if one that was
    /// inside lies outside now, or the other way round.
    bool change(const Body& body, const Placement& placement, std::span<const int> nodes);

    /// Binds it for the shaders of this body; their samplers, and the block of the pass.
    void bind() const;

    /// The nodes of the outside.
    void bind_rim() const { rim_.bind(rim_unit); }

    /// Makes it the pass of what runs next.
    void upload(const Pass& pass) const;

    // Nodes of infinite mass go where their guides lead them.

    /// The number of a node's guide, or -1.
    int guide_of(std::size_t node) const { return guide_[node]; }
    /// Sends them off.
    void lead(std::span<const Guide> guides);

    // Tools act on nodes.

    /// What pushes them during a call: all of each node together, and as it was handed in.
    void push(std::span<const NodePush> by_nodes, std::span<const NodePush> given);
    /// Where tips are in what runs next.
    void place(std::span<const RoundTip> tips);

    std::size_t bytes() const;

 private:
    std::vector<uvec4> traits_of_;  // of slots, as in
    gl::Field traits_, ties_, slots_, rim_;
    gl::Field obstacles_, distances_;
    std::vector<int> guide_;  // of each node
    gl::Field guides_;
    gl::Buffer uniforms_;
    const std::vector<int> slot_of_;  // each node's
    std::vector<int> push_of_;        // of each slot
    gl::Field push_of_slots_;
    std::optional<gl::Field> pushes_, tips_;
    mutable std::optional<Pass> pass_;  // in it
};

}  // namespace palpate::gpu
