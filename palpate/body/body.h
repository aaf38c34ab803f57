#pragma once
#include "palpate/base/vectors.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate {

/// One spring that every node of a grid has alike: to the node `offset` further on.
struct Link {
    ivec3 offset;
    float stiffness;  // N/m, of a whole link
    float rest;       // m
};

/// Springs implied by a grid (2005, section 3.1): a list of links that all nodes share, and for each node how
/// much of each link there is, in quarters: 0 none, 4 a whole one; three bits a link, the first link lowest,
/// so at most 21. A link and its opposite have the same share.
struct Stencil {
    std::vector<Link> links;
    std::vector<ivec3> at;              // each node's place in the grid
    std::vector<std::uint64_t> shares;  // one word a node

    int quarters(std::size_t node, std::size_t link) const { return int(shares[node] >> 3 * link & 7); }
};

/// Nodes and the springs between them. Plain data; the moving state belongs to a Solver.
/// Nodes stand in grid order, x fastest, with no gaps: nodes that do not exist take no memory.
struct Body {
    std::string name;
    std::vector<vec3> positions;      // m, at rest
    std::vector<float> inverse_mass;  // 1/kg; 0 pins the node
    std::vector<float> area;          // m², of the outside that a node stands for; 0 inside the body
    std::vector<float> cover;  // m, from a node out to the surface that hangs on it; negative if within
    Stencil springs;
    std::vector<std::array<int, 8>> cells;  // filled cells: corner nodes, x fastest, then y, then z
    float spacing = 0;                      // m, of the grid
    float damping = 0;                      // 1/s

    std::size_t count() const { return positions.size(); }
};

/// The node at the end of each link of each node, count × links; -1 where no node stands.
std::vector<int> neighbours(const Body& body);

/// Where each cell is in the grid: the place of its first corner.
std::vector<ivec3> cell_places(const Body& body);

/// Springs that exist, each counted once.
std::size_t spring_count(const Body& body);

/// Mass of the free nodes, kg.
double mass(const Body& body);

/// A body's moving state, in double so that a float state and a double one are both kept exactly.
struct State {
    std::vector<dvec3> positions;   // m
    std::vector<dvec3> velocities;  // m/s, at the time of the positions
};

/// How many cells lie inside out: their corners enclose no volume, or a negative one. A lattice that is
/// pressed together too hard gets stuck like this; it takes a finer lattice or a wider tip to avoid it.
std::size_t inverted_cells(const Body& body, std::span<const vec3> positions);

struct Energy {
    double kinetic = 0;  // J
    double elastic = 0;  // J, in the springs
};
Energy energy(const Body& body, const State& state);

}  // namespace palpate
