#pragma once
#include "palpate/solver/cpu/layout.h"
#include "palpate/solver/schedule.h"

#include <array>
#include <cstdint>
#include <vector>

// What the host hands to the kernels, which are compiled once for each instruction set.

namespace palpate::cpu {

/// One moving state.
struct Fields {
    float *x, *y, *z;     // m, from each node's place at rest
    float *vx, *vy, *vz;  // m/s
};

/// The springs a kernel is made for; other bodies write theirs out.
enum class Springs {
    lattice_whole,
    lattice,
    lattice_with_strength,
    turned_lattice,  // along any axes, and so are the other turned ones
    cloth,
    turned_cloth,
    volume,
    turned_volume,
    table
};

/// A spring of a table, of every slot.
struct TieFields {
    const int* to;           // slot
    const float *x, *y, *z;  // m, from node to neighbour at rest
    const float *share, *stiffness, *tension, *longest;
};

/// A body as it lies in memory: all that stays the same.
struct Laid {
    Springs springs;
    const Run* runs;
    const Block* blocks;
    const Bounds* rest_bounds;              // m, of each block's nodes
    const float* furthest_cover;            // m, of each block's nodes
    const int* offsets;                     // a grid's
    std::array<vec3, 32> along;             // a grid's: each link at rest, m
    float spacing;                          // m, where links follow the axes
    const std::uint32_t* words[2];          // a grid's shares, one bit a link, or three of ten links each
    const float* half_strength;             // half of each node's factor on stiffness; null: 1
    const TieFields* ties;                  // a table's
    const float* inverse_mass;              // 1/kg
    const float *rest_x, *rest_y, *rest_z;  // m
    const float *area, *cover;              // m², m
    const vec3* corners;                    // of polygons
    const DistanceField* const* fields;     // of closed meshes
    float finest;  // m: places at the end of a call are multiples of it, so that a double holds
                   // them exactly beside the place at rest
};

/// One pass over some blocks.
struct Sweep {
    const Laid& body;
    const Pass& pass;
    const Turn& turn;
    const Fields* states;  // as Where counts them
    std::array<Bounds*, 4>
        moved;  // of each state and block: how far its nodes have come from their places at rest, m
    std::array<int, 8> dragged;  // slot of each drag
};

/// The largest of what a sweep saw at the end of a call, squared.
struct Largest {
    float speed = 0, move = 0;  // m²/s², m²
};

/// What tips and drags give to the nodes of one block, N s.
struct Given {
    std::array<dvec3, 8> by_tip{}, by_drag{};
};

/// Whether a tip or a drag, or an obstacle, may touch nodes of a block that have come so far from their
/// places at rest.
bool touched(const Sweep& sweep, int block, const Bounds& moved);
bool near_obstacles(const Sweep& sweep, int block, const Bounds& moved);

/// The kernels for this machine's instruction set. Each works on the blocks from one to before another.
struct Kernels {
    const char* instructions;  // their name: AVX2, AVX3 (AVX-512), NEON …
    int lanes;                 // floats in a register
    void (*pass)(const Sweep&, int first_block, int end_block, Largest& largest);
    void (*give)(const Sweep&, int first_block, int end_block, Given* of_block);
    void (*find_bounds)(const Sweep&, int first_block, int end_block);
    void (*normals)(const Sweep&, int first_block, int end_block, float* x, float* y, float* z);
    bool (*torn)(const Sweep&, int first_block, int end_block);
};
Kernels kernels();

}  // namespace palpate::cpu
