#pragma once
#include "palpate/base/names.h"
#include "palpate/body/collider.h"

#include <span>
#include <vector>

namespace palpate {

enum class Backend {
    reference,  // one node after the other on one CPU core: the truth that other backends are held against
    cpu,        // as many nodes at once as the CPU's registers hold, on as many cores as it is given
    feedback,   // on the GPU: a vertex shader and transform feedback (2012)
    fragment,   // on the GPU: nodes laid flat in a texture, a fragment shader (2005)
    compute,    // on the GPU: a compute shader
};

/// Whether a backend needs OpenGL.
constexpr bool on_gpu(Backend backend) { return backend >= Backend::feedback; }

enum class Integrator {   // order, with damping of velocities; docs/integrators.md derives them
    explicit_euler,       // 1; stable only with damping
    semi_implicit_euler,  // 1, symplectic; called "implicit Euler" in the 2012 paper
    verlet,               // 2, symplectic
    midpoint,             // 2; undamped, it grows slowly at any step
    verlet_midpoint,      // 2, symplectic: Verlet with the acceleration taken at the midpoint
    rk4,                  // 4; four passes a step
};

inline std::span<const Named<Backend>> names(Backend) {
    static constexpr Named<Backend> all[] = {{Backend::reference, "reference"},
                                             {Backend::cpu, "cpu"},
                                             {Backend::feedback, "feedback"},
                                             {Backend::fragment, "fragment"},
                                             {Backend::compute, "compute"}};
    return all;
}

inline std::span<const Named<Integrator>> names(Integrator) {
    static constexpr Named<Integrator> all[] = {{Integrator::explicit_euler, "explicit-euler"},
                                                {Integrator::semi_implicit_euler, "semi-implicit-euler"},
                                                {Integrator::verlet, "verlet"},
                                                {Integrator::midpoint, "midpoint"},
                                                {Integrator::verlet_midpoint, "verlet-midpoint"},
                                                {Integrator::rk4, "rk4"}};
    return all;
}

inline constexpr int most_threads = 256;
inline constexpr double frame_seconds = 1.0 / 60;  // from picture to picture
inline constexpr int slices_per_frame = 17;
inline constexpr double slice_seconds = frame_seconds / slices_per_frame;  // the longest below 1 ms

/// How a body is moved.
struct Simulation {
    Backend backend = Backend::cpu;
    int threads =
        1;  // of the backend cpu, at most most_threads; the motion is the same to the bit with any number
    Integrator integrator = Integrator::verlet;
    double step = 0;     // s; 0 chooses 0.7 of the stability bound
    bool force = false;  // accept a step above the bound
    /// s: a body that needs shorter steps is refused, since a frame would take more than 1,000.
    double shortest_step = frame_seconds / 1000;
    vec3 gravity = vec3(0, -9.81f, 0);  // m/s²
    float air = 0;  // kg/m³: how dense the air is that moves, or stands; 1.2, or 0 for none
    std::vector<Collider> colliders = {};  // at most 16, with at most 1,000 triangles in all
};

}  // namespace palpate
