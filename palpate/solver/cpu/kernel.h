#pragma once
#include "palpate/solver/cpu/layout.h"
#include "palpate/solver/schedule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// What the host hands to the kernels, which are compiled once for each instruction set.

namespace palpate::cpu {

/// One moving state.
struct Fields {
    float *x, *y, *z;     // m, from each node's place at rest
    float *vx, *vy, *vz;  // m/s
    // The same, four floats a node, for kernels that look up neighbours one by one (show); else null.
    float *places, *speeds;
};

/// The springs that a kernel is compiled for; all other bodies use a table.
enum class Springs {
    lattice_whole,
    lattice,
    lattice_with_strength,
    turned_lattice,  // along any axes, and so are the other turned ones
    cloth,
    turned_cloth,
    volume,
    turned_volume,
    tissue,  // cells in place of springs, along any axes
    table
};

/// How the springs of a register of nodes are written out: as many for each.
struct Slice {
    int first;  // of its ties among all
    int count;
    int fan;  // the first so many go round the nodes in a sheet
};

/// Springs written out, as one stream for what a step needs. Each tie is a record of the same numbers for
/// each node of a register: where its neighbour lies in Fields::places; x, y, z of the way there at rest, m;
/// stiffness and tension of what there is of it, N/m and N. Beside it lies what is asked now and then.
struct Ties {
    const Slice* slices;
    const std::byte* pulling;
    const float* whole;  // share; stiffness of a whole one, N/m; longest, m²
};

/// Hinges written out in the same way, with no fan. A record says where the three others lie in
/// Fields::places; x of the ways there at rest, then y, then z, m; stiffness, rest and square of an area, as
/// of an OwnHinge; and 1 for an end of its edge, 0 for the tip of a triangle.
struct Hinges {
    const Slice* slices;
    const std::uint32_t* records;
};

/// Cells of tissue.
struct Cells {
    mat3 axes;             // columns: directions of their edges at rest; a grid's along the rows first
    const float* weights;  // a grid's: of the cell whose lowest corner is the node; 0 where there is none
    int reach;             // a grid's: slots from a node back to the first of the rows that hold its cells
    const std::uint32_t* records;  // a table's; null where it has none
};

/// What cells do to their corners, N, added up along the rows: of each slot what the cell there and the one
/// before it do to their corners there, and to those in the three rows beside. x, y, z of each row in turn,
/// 12 arrays of `size` and one register more. A slot stands at itself modulo `size`, which is as much as the
/// next nodes need: a layer of the grid or so, which stays in the cache unless the grid is very wide.
struct CellRing {
    float* numbers;
    int size;
};

/// m: so far both ends of a spring may come from their places at rest, and it is not torn yet, which it is at
/// a length whose square is `torn_at`, m². `way`: from end to end at rest.
inline float whole_within(float torn_at, vec3 way) {
    return std::max(0.499f * (std::sqrt(torn_at) - glm::length(way)), 0.0f);
}

/// A body in memory: everything that does not change during a call.
struct BodyView {
    Springs springs;
    const Run* runs;
    const Block* blocks;
    const Bounds* rest_bounds;    // m, of each block's nodes
    const float* furthest_cover;  // m, of each block's nodes
    const int* offsets;           // a grid's
    std::array<vec3, 32> along;   // a grid's: each link at rest, m
    float spacing;                // m, where links follow the axes
    /// A grid's shares, one bit a link, or three of ten links each; of tissue, from bit 24 of the second on,
    /// whether there is a cell of which the node is corner 0 or 1, 2 or 3 …
    const std::uint32_t* words[2];
    const float* half_strength;  // half of each node's factor on stiffness; null: 1
    Ties ties;                   // a table's
    Hinges hinges;               // a table's; null where it has none
    Cells cells;
    const float* inverse_mass;              // 1/kg
    const float *rest_x, *rest_y, *rest_z;  // m
    const float *area, *cover;              // m², m
    const vec3* corners;                    // of polygons
    const DistanceField* const* fields;     // of closed meshes
    float whole_within;  // m: nodes that have gone no farther from their places at rest tear no spring
    float finest;        // m: places at the end of a call are multiples of it, so that a double holds
                         // them exactly beside the place at rest
};

/// What pushes nodes: of every slot, zero where nothing does.
struct Pushes {
    std::span<const int> slots;             // of the nodes that are pushed, in order
    float *force_x, *force_y, *force_z;     // N
    float *target_x, *target_y, *target_z;  // m
    float* stiffness;                       // N/m
};

/// What a kernel works on: a pass over some of the blocks.
struct Task {
    const BodyView& body;
    const Pass& pass;
    const PassPlan& plan;
    const Fields* states;  // as StateBuffer counts them
    std::array<Bounds*, 4>
        moved;  // of each state and block: how far its nodes have come from their places at rest, m
    const Pushes* pushes = nullptr;
    CellRing cells = {};  // of whoever works on it
    /// N s, that tips give, as Kernels::give adds it up: a pass adds what they resist. While a block moves it
    /// is the block's.
    dvec3* given = nullptr;
};

/// The largest of what a pass saw at the end of a call, squared.
struct Largest {
    float speed = 0, move = 0;  // m²/s², m²
};

/// Whether a tip or a push may touch nodes of a block that have come so far from their places at rest;
/// whether an obstacle may have met them in this pass, on their way from where they were when the step began.
bool touched(const Task& task, int block, const Bounds& moved);
bool near_obstacles(const Task& task, int block, const Bounds& was, const Bounds& moved);

/// The kernels for this machine's instruction set. Each works on the blocks from one to before another.
struct Kernels {
    const char* instructions;  // their name: AVX2, AVX3 (AVX-512), NEON …
    int lanes;                 // floats in a register
    void (*pass)(const Task&, int first_block, int end_block, Largest& largest);
    /// Adds what tips give to the nodes of each block, N s: as many numbers a block as there are tips.
    void (*give)(const Task&, int first_block, int end_block, dvec3* given);
    void (*find_bounds)(const Task&, int first_block, int end_block);
    /// Neighbours in a table see where nodes have been put from outside. Before anything looks at neighbours.
    void (*show)(const Task&, int first_block, int end_block);
    void (*normals)(const Task&, int first_block, int end_block, float* x, float* y, float* z);
    bool (*torn)(const Task&, int first_block, int end_block);
};
Kernels kernels();

}  // namespace palpate::cpu
