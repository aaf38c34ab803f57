#pragma once
#include "palpate/base/vectors.h"
#include "palpate/solver_gl/placement.h"

#include <string>

namespace palpate::gpu {

/// How the compute pipeline cuts a grid into boxes of nodes, each a work group whose positions lie in memory
/// that its invocations share.
struct Tiles {
    ivec3 size = ivec3(0);    // nodes
    ivec3 reach = ivec3(0);   // of links beyond it
    ivec3 groups = ivec3(0);  // tiles along each axis
};

/// 16 x 16 nodes of a sheet, 8 x 8 x 4 of a solid.
Tiles tiles(const Body& body, const Placement& placement);

/// The defines that pass.comp wants.
std::string text(const Tiles& tiles, const Body& body, const Placement& placement);

}  // namespace palpate::gpu
