#pragma once
#include "palpate/run/contacts.h"
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

/// What users do to bodies during a frame, besides the scene's own tools: any number of presses and pulls.
struct Interaction {
    std::vector<Press> presses;
    std::vector<BodyPush> pulls;

    bool empty() const { return presses.empty() && pulls.empty(); }
};

/// The reaction forces on the user, N, averaged over the frame, in the same order.
struct InteractionForces {
    std::vector<dvec3> presses, pulls;
};

/// The simulation of a scene: a solver and a skin for each body, and a tip, a grip or a probe for each tool.
/// It fills in the report.
class Play {
 public:
    /// `context`: for a backend on the GPU. `frequencies`: of the bodies, if they are known; see make_solver.
    /// `follows_contacts`: bodies go on in slices of a millisecond, and contacts() has each of them.
    Play(const Scene& scene, const Models& made, Report& report, const gl::Context* context = nullptr,
         std::span<const double> frequencies = {}, bool follows_contacts = false);

    /// Simulates `seconds` from `time` on; mapping is deferred until it is needed. False if a body diverged:
    /// then the state is unchanged.
    bool advance(double time, double seconds, const Interaction& hands = {});

    /// The forces of the last frame's interaction.
    const InteractionForces& interaction_forces() const { return interaction_forces_; }

    /// What the scene's tools that press did to each body during the last frame: in its last slice, or in
    /// each.
    std::span<const ToolContact> contacts() const { return contacts_; }

    /// The pressure of these tools on each vertex of a body's skin at the end of the frame, Pa.
    std::vector<float> pressures(std::size_t body) const;

    /// Saves and restores the states of all bodies, exactly to the bit. Tools stay where they are on their
    /// paths.
    std::vector<State> save() const;
    void restore(const std::vector<State>& states);

    /// Takes over what the tools of another play touch and hold, for a scene with the same tools, nodes and
    /// vertices. Not the probes, which start over.
    void take_tools(const Play& from);
    /// Takes over the probes, which the other play loses.
    void take_probes(Play& from);

    double frequency(std::size_t body) const { return world_.solver(body).frequency(); }

    /// The memory of all states, bytes.
    std::size_t memory() const;

    /// The steps for a frame of 1/60 s of the body that needs most.
    int steps_per_frame() const;

    /// The solvers' statistics of the last frame, one for each body; empty before the first.
    std::span<const Stats> stats() const { return stats_.bodies; }

    /// The bodies at one moment, each with its velocities at the time of its positions.
    std::vector<State> states() const;

    // ---- for drawing ----

    /// Those of the bodies, then the static surfaces.
    const std::vector<Skin>& skins() const;

    /// The same in less time: their normals may be older than their positions.
    const std::vector<Skin>& touchable() const;

    /// The dents of all tools in a skin.
    std::vector<Dent> dents(std::size_t skin) const;

    Nodes nodes(std::size_t body) const { return world_.solver(body).nodes(); }
    GpuNodes gpu_nodes(std::size_t body) const { return world_.solver(body).gpu_nodes(); }

    /// The position of a tool, and of the node that it drags, if any.
    struct Tool {
        vec3 centre;
        std::optional<vec3> held;
    };
    const std::vector<std::optional<Tool>>& tools() const { return tools_; }

    /// The colliders at a time, moving evenly to their places `seconds` later.
    std::vector<Motion> colliders(double time, double seconds) const;

 private:
    struct Acting;  // everything that acts during a frame
    Acting acting(double time, double seconds, const Interaction& hands);
    bool step(double seconds, const Acting& on);
    void map() const;
    void count_inverted_cells(double time);
    void probe(double time, double seconds);
    std::vector<Press> press(double time, double seconds, std::span<const dvec3> reactions);
    void measure(const Acting& on, double time, double seconds, const WorldSlice& slice);
    std::vector<double> on_pad(const ToolContact& contact) const;
    void record(const Acting& on, double time, double seconds);

    const Scene& scene_;
    const Models& made_;
    Report& report_;
    mutable World world_;  // whose team maps the skins, too
    WorldStats stats_;
    mutable std::vector<Skin> skins_;
    enum class Mapped { no, positions, all };
    mutable Mapped mapped_ = Mapped::no;                   // how far the skins match the nodes
    std::vector<std::variant<Tip, Grip, Probe>> handles_;  // one a tool
    std::vector<std::optional<Tool>> tools_;
    InteractionForces interaction_forces_;
    const bool follows_contacts_;
    std::vector<ToolContact> contacts_;
    double time_ = 0;      // s
    double counted_ = -1;  // s, when inverted cells were last counted
};

/// The even motion of a collider, which is given about its pivot, from one pose to the next.
Motion motion_between(const Pose& from, const Pose& to, vec3 pivot, double seconds);

}  // namespace palpate
