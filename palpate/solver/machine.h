#pragma once
#include "palpate/body/nodes.h"
#include "palpate/solver/schedule.h"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace palpate {

namespace gl {
class Context;
}
class Team;

/// What a machine found out during a call.
struct Findings {
    bool torn = false;                                       // the motion has blown up
    double largest_speed = 0;                                // m/s, of any node at the end, in the world
    double largest_move = 0;                                 // m, of any node in the last step, in the world
    dvec3 first_node = dvec3(0), first_velocity = dvec3(0);  // m and m/s, at the end
    std::vector<dvec3> by_presses, by_pushes;                // N s that each gave to the nodes
};

/// Where the nodes of a body live and how they are gone over: memory and loops, which is all that backends
/// differ in. What a step is stands in Solver and Call; what a node does, in node.inl. Places and velocities
/// are counted from an origin that the solver chooses (origin.h). Before all else a state is put.
class Machine {
 public:
    virtual ~Machine() = default;

    /// The body's springs, masses or outside have changed at these nodes; the state is put next. False, and
    /// nothing has changed, where its memory cannot be updated in place.
    virtual bool change(std::span<const int> nodes) {
        static_cast<void>(nodes);
        return false;
    }

    /// Runs all passes of a call.
    virtual Findings run(const Call& call) = 0;

    /// The current state, as it lies in memory: exact, so that get() after put() is what was put.
    virtual void put(const State& state, const Origin& origin) = 0;
    virtual State get() const = 0;

    /// Takes this off all places, m, and velocities, m/s: they are counted from another origin now.
    virtual void shift(dvec3 place, dvec3 velocity) = 0;

    /// To the field `before`, or back from there: the current state before a call.
    virtual void remember() = 0;
    virtual void bring_back(const Origin& origin) = 0;

    /// The velocities of the current state after this pass, which only kicks.
    virtual std::vector<dvec3> kicked(const Pass& pass) const = 0;

    /// Current positions in the world and approximate normals, in the body's order, for the host.
    virtual void show(const Origin& origin, std::vector<vec3>& positions,
                      std::vector<vec3>& normals) const = 0;
    /// The same where they are, if that is on a GPU.
    virtual GpuNodes gpu_nodes() const { return {}; }

    /// Bytes that states and springs take.
    virtual std::size_t memory() const = 0;
};

// The machines, a folder each. Body and simulation were checked, and must outlive the machine.

/// One node after the other. Real is float, which other machines must match, or double, which shows orders of
/// convergence without rounding in the way.
template <class Real>
std::unique_ptr<Machine> make_reference(const Body& body, const Simulation& simulation);

/// As many nodes at once as a register holds, on the threads of `team`, or of its own.
std::unique_ptr<Machine> make_cpu(const Body& body, const Simulation& simulation, Team* team = nullptr);

/// The instruction set that it uses here: AVX2, AVX3 (that is AVX-512), SSE4, NEON, or SCALAR.
std::string_view cpu_instructions();

/// In OpenGL: feedback, fragment or compute. It leaves a context's program, vertex array, framebuffer,
/// viewport and bindings as they were. `tiles`: whether `compute` keeps the positions of a work group's nodes
/// in shared memory; by itself it does so on a graphics card, since a software driver reaches its caches
/// faster. Throws Error if there is no OpenGL, or no room for the body.
std::unique_ptr<Machine> make_gpu(const Body& body, const Simulation& simulation, const gl::Context* context,
                                  std::optional<bool> tiles = {});

}  // namespace palpate
