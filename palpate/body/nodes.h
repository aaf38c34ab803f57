#pragma once
#include "palpate/base/vectors.h"

#include <cstddef>
#include <span>

namespace palpate {

/// Where the current state of a body's nodes is, for whoever maps or draws them. Valid until the solver's
/// next step.
struct Nodes {
    std::span<const vec3> positions;  // m
    std::span<const vec3>
        normals;  // approximate normals (2005, eq. 3), not normalised: a short one is ill defined
};

/// The same in the memory of a GPU: names of OpenGL buffers or textures that hold a vec4 for each node (x, y,
/// z, and whatever), in the order of the body's nodes. Whoever moves nodes on a GPU can fill one in.
struct GpuNodes {
    unsigned positions = 0;  // 0: there are none
    unsigned normals = 0;    // 0: none, and nothing that needs approximate normals may be asked for
    int width = 0;           // 0: they are buffers; else flat textures (RGBA32F), so many texels wide
    std::size_t count = 0;   // of nodes
    Bounds bounds = {};      // around all of them, m: whoever draws cannot look into the GPU's memory
};

}  // namespace palpate
