#pragma once
#include "palpate/base/vectors.h"

#include <cstddef>
#include <span>

namespace palpate {

/// A view of the current state of a body's nodes, for mapping and drawing. Valid until the solver's next
/// step.
struct Nodes {
    std::span<const vec3> positions;  // m
    std::span<const vec3>
        normals;  // approximate normals (2005, eq. 3), not normalised: the shorter, the less reliable
};

/// The same in the memory of a GPU: names of OpenGL buffers or textures that hold a vec4 for each node (x, y,
/// z, and an unused w), in the order of the body's nodes. A program that moves nodes on a GPU can fill one
/// in.
struct GpuNodes {
    unsigned positions = 0;  // 0: there are none
    unsigned normals = 0;    // 0: there are none; then nothing may be drawn that needs approximate normals
    int width = 0;           // 0: they are buffers; otherwise they are 2D textures (RGBA32F) of this width in
                             // texels
    std::size_t count = 0;   // of nodes
    Bounds bounds = {};      // the bounding box of all nodes, m, as the host does not read the GPU's memory
                             // to draw
};

}  // namespace palpate
