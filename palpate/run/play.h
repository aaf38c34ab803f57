#pragma once
#include "palpate/run/grip.h"
#include "palpate/run/probe.h"
#include "palpate/run/report.h"
#include "palpate/run/tip.h"
#include "palpate/scene/build.h"
#include "palpate/solver/world.h"

#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace palpate {

/// What hands do to bodies during a frame, besides the scene's own tools. Any number.
struct Hands {
    std::vector<Press> presses;
    std::vector<BodyPush> pulls;

    bool empty() const { return presses.empty() && pulls.empty(); }
};

/// The forces on them, N, mean over the frame, in their order.
struct Pushes {
    std::vector<dvec3> presses, pulls;
};

/// A scene in motion: a solver and a skin for each body, a tip, a grip or a probe for each tool. What it does
/// goes into the report.
class Play {
 public:
    /// On a GPU, in that context. `frequencies`: of the bodies, where they are known; see make_solver.
    Play(const Scene& scene, const Models& made, Report& report, const gl::Context* context = nullptr,
         std::span<const double> frequencies = {});

    /// Simulates and maps `seconds` from `time` on; what moves on a GPU is mapped when somebody asks for it.
    /// False if a body diverged: then all are as they were before.
    bool advance(double time, double seconds, const Hands& hands = {});

    /// What the hands of the last frame felt.
    const Pushes& pushes() const { return pushes_; }

    /// All bodies as their integrators keep them, and going on from there, to the bit. Tools stay where they
    /// are on their paths.
    std::vector<State> save() const;
    void restore(const std::vector<State>& states);

    /// Goes on from another play of a scene with the same tools and the same nodes and vertices: its tools
    /// have touched what those had, and hold what those held. Not those that are felt, which begin anew.
    void take_tools(const Play& from);
    /// Those that are felt, which are the other's no more.
    void take_probes(Play& from);

    double frequency(std::size_t body) const { return world_.solver(body).frequency(); }

    /// Bytes that all moving states take.
    std::size_t memory() const;

    /// Steps that the busiest body takes for a frame of 1/60 s.
    int steps_per_frame() const;

    /// What the solvers said of the last frame, one a body; empty before the first.
    std::span<const Stats> stats() const { return stats_.bodies; }

    /// The bodies at one moment, each with its velocities at the time of its positions.
    std::vector<State> states() const;

    // ---- what there is to see ----

    /// The bodies', then those that nothing moves.
    const std::vector<Skin>& skins() const;

    /// What all tools make of a skin.
    std::vector<Dent> dents(std::size_t skin) const;

    Nodes nodes(std::size_t body) const { return world_.solver(body).nodes(); }
    GpuNodes gpu_nodes(std::size_t body) const { return world_.solver(body).gpu_nodes(); }

    /// Where a tool is, if it is there, and the node that it drags, if it does.
    struct Tool {
        vec3 centre;
        std::optional<vec3> held;
    };
    const std::vector<std::optional<Tool>>& tools() const { return tools_; }

    /// Where the colliders are at a time, and how they move on to their places `seconds` later.
    std::vector<Motion> colliders(double time, double seconds) const;

 private:
    struct Acting;  // all that acts during a frame
    Acting acting(double time, double seconds, const Hands& hands);
    bool step(double seconds, const Acting& on);
    void map() const;
    void probe(double time, double seconds);
    void record(const Acting& on, double time, double seconds);

    const Scene& scene_;
    const Models& made_;
    Report& report_;
    mutable World world_;  // whose team carries the skins, too
    WorldStats stats_;
    mutable std::vector<Skin> skins_;
    mutable bool mapped_ = false;                          // they are where the nodes are
    std::vector<std::variant<Tip, Grip, Probe>> handles_;  // one a tool
    std::vector<std::optional<Tool>> tools_;
    Pushes pushes_;
    double time_ = 0;      // s
    bool probes_ = false;  // whether any tool is one
};

/// How a collider moves that is given about its pivot: evenly from one pose to the next.
Motion motion_between(const Pose& from, const Pose& to, vec3 pivot, double seconds);

}  // namespace palpate
