#pragma once
#include "palpate/base/vectors.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

/// One spring that every node of a grid has alike: to the node `offset` further on.
struct Link {
    ivec3 offset;
    float stiffness;  // N/m, of a whole link
    float rest;       // m

    bool operator==(const Link&) const = default;
};

/// Springs implied by a grid (2005, section 3.1): a list of links that all nodes share, and for each node how
/// much of each link there is. A link and its opposite have the same share. Body::at says where nodes stand.
struct GridSprings {
    std::vector<Link> links;  // at most 32
    /// One word a node, the first link lowest. Up to 21 links: three bits each, in quarters, from 0 for none
    /// to 4 for a whole link. More links: one bit each, a whole link or none.
    std::vector<std::uint64_t> shares;
    /// Factors on the stiffness, one a node, where parts of the body are harder or softer than the rest; a
    /// spring takes the mean of its ends'. Empty: 1 everywhere.
    std::vector<float> strength;

    /// Whether shares are quarters, rather than whole or none.
    bool in_quarters() const { return links.size() <= 21; }
    /// How much of a link a node has, 0 to 4.
    int quarters(std::size_t node, std::size_t link) const {
        return in_quarters() ? int(shares[node] >> 3 * link & 7) : int(shares[node] >> link & 1) * 4;
    }
    /// The same set, in quarters; where there is no room for quarters, 0 or 4.
    void set_quarters(std::size_t node, std::size_t link, int quarters);

    bool operator==(const GridSprings&) const = default;
};

/// A spring between two nodes.
struct Spring {
    int a, b;
    float stiffness;  // N/m
    float rest = 0;   // m

    bool operator==(const Spring&) const = default;
};

/// Springs that are listed one by one: of bodies without a grid (the connection buffer of 2012), and stitches
/// and ropes beside a grid's.
struct ListedSprings {
    std::vector<Spring> springs;

    bool operator==(const ListedSprings&) const = default;
};

/// Where two triangles of a sheet meet: the edge from -> to of (from, to, left) and (to, from, right), each
/// counter-clockwise from outside. It is the same hinge with `from` and `to`, and `left` and `right`, the
/// other way round.
struct Hinge {
    int from, to, left, right;
    float stiffness;  // N m, per radian
    float rest = 0;   // twice the sine of half the angle between its triangles' normals at rest; above 0
                      // where they fold up towards their outside

    bool operator==(const Hinge&) const = default;
};

/// Hinges that resist being bent, so that a sheet is stiff as a plate is.
struct Bending {
    std::vector<Hinge> hinges;

    bool operator==(const Bending&) const = default;
};

/// The cells of a grid, Body::cells, as pieces of a neo-Hookean solid (solver/terms/cells.inl): of any
/// Poisson's ratio, and a cell that is turned inside out turns back. At rest they are cubes. The springs of
/// the grid stand before it and say which nodes are neighbours; where there is nothing but tissue, their
/// stiffness is 0.
struct TissueCells {
    float youngs_modulus;  // Pa
    float poisson;  // Poisson's ratio, from 0 to below 1/2; tissue that keeps its volume has 0.45 to 0.49
    std::vector<float> filled;   // one a cell: how much of it the solid fills; mass goes with it
    std::vector<float> weights;  // the same times how much stiffer the cell is than the rest

    /// Lamé's parameters, Pa.
    float shear() const { return youngs_modulus / (2 * (1 + poisson)); }
    float lame() const { return 2 * shear() * poisson / (1 - 2 * poisson); }

    bool operator==(const TissueCells&) const = default;
};

/// What pulls at nodes: a kind of force with its numbers. Its equations are in solver/terms/.
using Term = std::variant<GridSprings, ListedSprings, Bending, TissueCells>;

/// Nodes, and what pulls at them. Plain data; the moving state belongs to a Solver.
/// In a grid, nodes stand in its order, x fastest, with no gaps: nodes that do not exist take no memory.
struct Body {
    std::string name;
    std::vector<vec3> positions;      // m, at rest
    std::vector<float> inverse_mass;  // 1/kg; 0: no force moves the node
    std::vector<float> area;          // m², of the outside that a node stands for; 0 inside the body
    std::vector<float> cover;  // m, from a node out to the surface that hangs on it; negative if within
    std::vector<ivec3> at;     // each node's place in the grid; empty where there is none
    std::vector<Term> terms;   // the springs of a grid, if any, come first
    /// In a sheet, so many neighbours of each node go round it counter-clockwise, so that their cross
    /// products sum to its normal; 0 in a solid. In a grid they are the first links; else `rings` lists them,
    /// for each node in turn: of a closed ring that is shorter the first again, of an open one -1.
    int fan = 0;
    std::vector<int> rings;
    std::vector<std::array<int, 8>> cells;  // filled cells: corner nodes, x fastest, then y, then z
    std::vector<std::array<int, 3>>
        faces;               // triangles of nodes, where the body is a sheet or a net of springs
    float spacing = 0;       // m, of the grid; elsewhere the mean length of the springs
    float damping = 0;       // 1/s, of velocities
    float link_damping = 0;  // s: springs and hinges resist their change with this × stiffness

    std::size_t count() const { return positions.size(); }
    /// The springs of its grid; null where it has none.
    const GridSprings* grid() const { return terms.empty() ? nullptr : std::get_if<GridSprings>(&terms[0]); }
    GridSprings* grid() { return terms.empty() ? nullptr : std::get_if<GridSprings>(&terms[0]); }
};

/// A spring as the node at one of its ends sees it.
struct Tie {
    int to = -1;          // the node at the other end; -1: there is none
    float share = 0;      // how much of it there is, 0 to 1
    float stiffness = 0;  // N/m, of a whole one
    float rest = 0;       // m

    bool operator==(const Tie&) const = default;
};

/// All springs of a body as its nodes see them: as many ties for each node, some of them empty. The first
/// Body::fan go round it in a sheet.
struct Table {
    int width = 0;          // ties a node
    std::vector<Tie> ties;  // count × width

    std::span<const Tie> of(std::size_t) const&& = delete;  // it would outlive its table
    std::span<const Tie> of(std::size_t node) const& {
        return {ties.data() + node * std::size_t(width), std::size_t(width)};
    }

    bool operator==(const Table&) const = default;
};

/// A hinge as one of its four nodes sees it: as an end of its edge, which it then counts from, or as the tip
/// of a triangle, which it then counts as the left one.
struct OwnHinge {
    bool is_end;
    std::array<int, 3> others;  // to, left, right for an end; from, to, right for a tip
    float stiffness, rest;      // as of a Hinge
    float area_square;          // m⁴, of the smaller of its triangles at rest; never quite 0
};

/// The cells around a node of tissue: -1, or the number of the cell of which it is corner k.
using OwnCells = std::array<int, 8>;

/// What messages call it.
std::string name_in_errors(const Body& body);

/// Throws Error where its lists are not as long as one another, name nodes that it does not have, or hold
/// what is not finite. Everything that makes a solver or embeds a surface calls this first.
void check(const Body& body);

/// The springs of any body as its nodes see them; a grid's links stay in their order, and come first.
Table table(const Body& body);

bool has_hinges(const Body& body);

/// The hinges of a body as its nodes see them: for each node all that it belongs to.
std::vector<std::vector<OwnHinge>> own_hinges(const Body& body);

/// The tissue of a body; null where it has none.
const TissueCells* tissue_of(const Body& body);

/// The cells of a body as its nodes see them.
std::vector<OwnCells> own_cells(const Body& body);

/// The same body with its springs listed one by one, and no grid or cells any more: without its tissue.
Body without_grid(Body body);

/// The springs of any body, each once: pairs of nodes.
std::vector<uvec2> spring_ends(const Body& body);

/// Where each cell is in the grid: the place of its first corner.
std::vector<ivec3> cell_places(const Body& body);

/// The mean edges of a body's cells at rest, m: along which the axes of its grid lie, however it is turned.
/// Zero where there are no cells.
mat3 cell_edges(const Body& body);

/// Mass of the free nodes, kg.
double mass(const Body& body);

/// A body's moving state, in double so that a float state and a double one are both kept exactly.
struct State {
    std::vector<dvec3> positions;   // m
    std::vector<dvec3> velocities;  // m/s
    double lag = 0;  // s, how far the velocities are behind the positions (half a step in Verlet)
};

/// How many cells lie inside out: their corners enclose no volume, or one of another sign than at rest. A
/// lattice that is pressed together too hard gets stuck like this; it takes a finer lattice or a wider tip to
/// avoid it.
std::size_t inverted_cells(const Body& body, std::span<const vec3> positions);

}  // namespace palpate
