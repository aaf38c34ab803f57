#pragma once
#include "palpate/solver/solver.h"

#include <optional>

namespace palpate {

/// The backends of the GPU: feedback, fragment and compute, which differ in how they load and store nodes
/// (solver/gpu/pipeline.h). Grids keep their neighbours implied, all else looks them up. A solver leaves the
/// context's program, vertex array, framebuffer, viewport and bindings of textures and buffers as it needed
/// them. `frequency`: the body's highest, rad/s. Throws Error if there is no OpenGL, or no room for the body.
/// `tiles`: whether `compute` keeps the positions of a work group's nodes in shared memory; by itself it does
/// so on a graphics card, since a software driver reaches its caches faster.
std::unique_ptr<Solver> make_gpu(const Body& body, const Simulation& simulation, double frequency,
                                 const gl::Context* context, std::optional<bool> tiles = {});

}  // namespace palpate
