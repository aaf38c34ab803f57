#pragma once
#include "palpate/base/vectors.h"

#include <array>

// The links of the grids that Palpate makes, in their order: in nodes along x, y, z. Backends have kernels of
// their own for these.

namespace palpate {

/// Of a volume in 2012, section 3; the first 18 of a lattice (2005, section 3.1): along the axes and the
/// diagonals of faces. What 2012 adds are the diagonals of cells and the next but one along each axis. A link
/// and its opposite stand side by side.
inline constexpr std::array<ivec3, 32> volume_links = {{
    {1, 0, 0},  {-1, 0, 0},   {0, 1, 0},  {0, -1, 0},  {0, 0, 1},  {0, 0, -1},                            //
    {1, 1, 0},  {-1, -1, 0},  {1, -1, 0}, {-1, 1, 0},  {1, 0, 1},  {-1, 0, -1},                           //
    {1, 0, -1}, {-1, 0, 1},   {0, 1, 1},  {0, -1, -1}, {0, 1, -1}, {0, -1, 1},                            //
    {1, 1, 1},  {-1, -1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1},  //
    {2, 0, 0},  {-2, 0, 0},   {0, 2, 0},  {0, -2, 0},  {0, 0, 2},  {0, 0, -2},
}};
inline constexpr int lattice_links = 18;

/// Of a cloth (2012, section 3): structural, shear, flexion. Those round a node first, so that they make its
/// fan.
inline constexpr std::array<ivec3, 12> cloth_links = {{
    {1, 0, 0},
    {0, 1, 0},
    {-1, 0, 0},
    {0, -1, 0},  //
    {1, 1, 0},
    {-1, 1, 0},
    {-1, -1, 0},
    {1, -1, 0},  //
    {2, 0, 0},
    {0, 2, 0},
    {-2, 0, 0},
    {0, -2, 0},
}};

}  // namespace palpate
