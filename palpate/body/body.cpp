#include "palpate/body/body.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace palpate {
namespace {

// The mean edges of a cell along its three axes: they span a box of the cell's volume, nearly.
dmat3 edges_of(const std::array<int, 8>& nodes, std::span<const vec3> positions) {
    dmat3 edges(0);
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            edges[axis] += (corner >> axis & 1 ? 0.25 : -0.25) * dvec3(positions[std::size_t(nodes[corner])]);
    return edges;
}

// Whether each place is another, and a box around all is no larger than memory should be for them.
bool is_compact(std::span<const ivec3> places) {
    if (places.empty()) return true;
    dvec3 low(places[0]), high(low);
    for (ivec3 p : places) low = glm::min(low, dvec3(p)), high = glm::max(high, dvec3(p));
    const dvec3 size = high - low + 1.0;
    if (!(size.x * size.y * size.z <= 3e8)) return false;
    const GridIndex grid(places);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (grid.at(places[i]) != int(i)) return false;
    return true;
}

// Whether all cells at rest are cubes of the body's spacing, within what rounding makes of them, and their
// corners stand in the grid as they do.
bool has_cubes(const Body& body) {
    float farthest = 0;
    for (vec3 p : body.positions)
        farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double hair = 1e-3 * body.spacing + 4.0 * std::numeric_limits<float>::epsilon() * double(farthest);
    return std::ranges::all_of(body.cells, [&](const std::array<int, 8>& nodes) {
        const dmat3 edges = edges_of(nodes, body.positions);
        bool is_cube = glm::determinant(edges) > 0;
        for (int k = 0; k < 8; ++k)
            is_cube = is_cube && body.at[std::size_t(nodes[std::size_t(k)])] ==
                                     body.at[std::size_t(nodes[0])] + cell_corner(k);
        for (int k = 0; k < 3; ++k) {
            is_cube = is_cube && std::abs(glm::length(edges[k]) - body.spacing) <= hair;
            is_cube = is_cube && std::abs(glm::dot(edges[k], edges[(k + 1) % 3])) <= hair * body.spacing;
        }
        return is_cube;
    });
}

bool are_different(std::vector<int> numbers) {
    std::ranges::sort(numbers);
    return std::ranges::adjacent_find(numbers) == numbers.end();
}

void check_count(const Body& body, std::size_t positions) {
    if (positions < body.count())
        throw Error(fmt::format("{} positions of {} nodes", positions, body.count()), name_in_errors(body),
                    "hand in one for each");
}

}  // namespace

std::string name_in_errors(const Body& body) { return body.name.empty() ? "the body" : "body " + body.name; }

void check(const Body& body) {
    auto require = [&](bool holds, std::string_view what, std::string_view remedy) {
        if (!holds) throw Error(what, name_in_errors(body), remedy);
    };
    const std::size_t count = body.count();
    auto has = [&](int node) { return node >= 0 && std::size_t(node) < count; };
    auto is_some = [](float value) { return value >= 0 && std::isfinite(value); };
    require(body.inverse_mass.size() == count && body.area.size() == count && body.cover.size() == count,
            "lists of another length than its positions",
            "give every node an inverse mass, an area and a cover");
    require(std::ranges::all_of(body.positions, [](vec3 p) { return std::isfinite(p.x + p.y + p.z); }),
            "a node at a place that is not finite", "give places in m");
    require(std::ranges::all_of(body.inverse_mass, is_some) && std::ranges::all_of(body.area, is_some) &&
                std::ranges::all_of(body.cover, [](float value) { return std::isfinite(value); }),
            "an inverse mass or an area that is negative or not finite",
            "give each node a mass above zero, or 0 to hold it");
    require(is_some(body.spacing) && (body.spacing > 0 || body.cells.empty()),
            "a spacing that is negative or not finite, or none beside cells",
            "say how far its nodes are apart, in m");
    require(is_some(body.damping) && is_some(body.link_damping), "a damping that is negative or not finite",
            "use 0 or more");
    require(body.at.empty() || body.at.size() == count, "places in the grid of another number of nodes",
            "give every node one, or none");
    require(is_compact(body.at), "a grid with two nodes at one place, or in too large a box",
            "give every node a place of its own, with few empty ones between them");
    for (const Term& term : body.terms)
        if (const auto* grid = std::get_if<GridSprings>(&term)) {
            require(grid == body.grid(), "springs of a grid that are not its first term",
                    "list other springs one by one");
            require(body.at.size() == count, "springs of a grid without one",
                    "give every node a place in it");
            require(grid->links.size() <= 32, "more than 32 links a node", "list its springs one by one");
            require(
                grid->shares.size() == count && (grid->strength.empty() || grid->strength.size() == count),
                "shares or strengths of another number of nodes", "give every node its own");
            for (const Link& link : grid->links)
                require(is_some(link.stiffness) && is_some(link.rest),
                        "a link whose stiffness or length is negative or not finite",
                        "give them in N/m and m");
            require(std::ranges::all_of(grid->strength, is_some), "a strength that is negative or not finite",
                    "use 0 or more");
        } else if (const auto* listed = std::get_if<ListedSprings>(&term)) {
            for (const Spring& spring : listed->springs)
                require(
                    has(spring.a) && has(spring.b) && is_some(spring.stiffness) && is_some(spring.rest),
                    "a spring to a node that it does not have, or whose numbers are negative or not finite",
                    "count nodes from 0");
        } else if (const auto* bending = std::get_if<Bending>(&term)) {
            for (const Hinge& hinge : bending->hinges) {
                std::array nodes{hinge.from, hinge.to, hinge.left, hinge.right};
                std::ranges::sort(nodes);
                require(std::ranges::all_of(nodes, has) && std::ranges::adjacent_find(nodes) == nodes.end() &&
                            is_some(hinge.stiffness),
                        "a hinge whose four nodes it does not have or are not four, or whose stiffness is "
                        "negative or not finite",
                        "count nodes from 0");
                require(std::abs(hinge.rest) <= 2, "a hinge bent by more than half a turn at rest",
                        "give it twice the sine of half the angle, from -2 to 2");
            }
        }
    const int links = body.grid() ? int(body.grid()->links.size()) : 0;
    const bool has_rings = !body.rings.empty() || links == 0;
    require(
        body.fan >= 0 && (has_rings ? body.rings.size() == count * std::size_t(body.fan) : body.fan <= links),
        "a fan of more springs than a node has, or rings of another length", "use as many, or 0 in a solid");
    require(std::ranges::all_of(body.rings, [&](int node) { return node == -1 || has(node); }),
            "a ring with a node that it does not have", "count nodes from 0; -1 is none");
    require(body.cells.empty() || body.at.size() == count, "cells without a grid",
            "give every node a place in it, or leave the cells out");
    for (const auto& cell : body.cells)
        require(std::ranges::all_of(cell, has), "a cell of a node that it does not have",
                "count nodes from 0");
    if (const TissueCells* cells = tissue_of(body)) {
        require(cells->youngs_modulus > 0 && std::isfinite(cells->youngs_modulus),
                "tissue without a Young's modulus above zero", "give it in Pa");
        require(cells->poisson >= 0 && cells->poisson <= 0.499f,
                "a Poisson's ratio that is not from 0 to 0.499", "organs have 0.45 to 0.49");
        auto is_above_zero = [&](float w) { return w > 0 && is_some(w); };
        require(cells->filled.size() == body.cells.size() && cells->weights.size() == body.cells.size() &&
                    std::ranges::all_of(cells->filled, is_above_zero) &&
                    std::ranges::all_of(cells->weights, is_above_zero),
                "tissue without a weight above zero for each cell", "1 is a whole cell");
        std::vector<int> lowest;
        for (const auto& cell : body.cells) lowest.push_back(cell[0]);
        require(are_different(std::move(lowest)) &&
                    std::ranges::count_if(
                        body.terms,
                        [](const Term& term) { return std::holds_alternative<TissueCells>(term); }) == 1,
                "two cells in one place, or tissue twice", "give each cell once");
        require(body.grid() && has_cubes(body), "tissue in cells that are not cubes at rest",
                "make it of a lattice");
    }
    for (const auto& face : body.faces)
        require(std::ranges::all_of(face, has), "a face of a node that it does not have",
                "count nodes from 0");
}

void GridSprings::set_quarters(std::size_t node, std::size_t link, int quarters) {
    const std::size_t bits = in_quarters() ? 3 : 1, at = bits * link;
    const std::uint64_t all = in_quarters() ? 7 : 1,
                        value = std::uint64_t(in_quarters() ? quarters : quarters / 4);
    shares[node] = (shares[node] & ~(all << at)) | value << at;
}

namespace {

// Ties to all that the grid's links lead to.
void add_ties(const Body& body, const GridSprings& grid, std::vector<std::vector<Tie>>& ties) {
    const GridIndex node_at(body.at);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < grid.links.size(); ++l) {
            const Link& link = grid.links[l];
            const int quarters = grid.quarters(i, l);
            const int to = quarters > 0 ? node_at.at(body.at[i] + link.offset) : -1;
            const float strength =
                grid.strength.empty() || to < 0 ? 1 : 0.5f * (grid.strength[i] + grid.strength[to]);
            ties[i].push_back({to, 0.25f * float(quarters), strength * link.stiffness, link.rest});
        }
}

void add_ties(const Body&, const ListedSprings& listed, std::vector<std::vector<Tie>>& ties) {
    for (const Spring& spring : listed.springs) {
        ties[std::size_t(spring.a)].push_back({spring.b, 1, spring.stiffness, spring.rest});
        ties[std::size_t(spring.b)].push_back({spring.a, 1, spring.stiffness, spring.rest});
    }
}

// These have no springs.
void add_ties(const Body&, const Bending&, std::vector<std::vector<Tie>>&) {}
void add_ties(const Body&, const TissueCells&, std::vector<std::vector<Tie>>&) {}

// The neighbours round a node come first, each with the first spring to it, if there is one.
std::vector<Tie> in_a_ring(const Body& body, std::size_t node, std::vector<Tie> ties) {
    std::vector<Tie> sorted;
    const auto ring = std::span(body.rings).subspan(node * std::size_t(body.fan), std::size_t(body.fan));
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const int to = ring[k];
        const auto found = std::ranges::find(ties, to, &Tie::to);
        const bool again = std::ranges::find(ring.first(k), to) != ring.first(k).end();
        if (to < 0) {
            sorted.push_back({});
        } else if (again || found == ties.end()) {
            sorted.push_back(
                {to, 0, 0, glm::distance(body.positions[node], body.positions[std::size_t(to)])});
        } else {
            sorted.push_back(*found);
            ties.erase(found);
        }
    }
    sorted.insert(sorted.end(), ties.begin(), ties.end());
    return sorted;
}

}  // namespace

Table table(const Body& body) {
    std::vector<std::vector<Tie>> lists(body.count());
    for (const Term& term : body.terms)
        std::visit([&](const auto& one) { add_ties(body, one, lists); }, term);
    if (!body.rings.empty())
        for (std::size_t i = 0; i < lists.size(); ++i) lists[i] = in_a_ring(body, i, std::move(lists[i]));
    Table table;
    for (const auto& list : lists) table.width = std::max(table.width, int(list.size()));
    table.ties.reserve(lists.size() * std::size_t(table.width));
    for (const auto& list : lists) {
        table.ties.insert(table.ties.end(), list.begin(), list.end());
        table.ties.resize(table.ties.size() + std::size_t(table.width) - list.size());
    }
    return table;
}

namespace {

// m⁴, of a triangle of nodes at rest.
float area_square(const Body& body, int a, int b, int c) {
    const vec3 from = body.positions[std::size_t(a)], to = body.positions[std::size_t(b)] - from,
               third = body.positions[std::size_t(c)] - from;
    const vec3 doubled = glm::cross(to, third);
    return 0.25f * glm::dot(doubled, doubled);
}

}  // namespace

bool has_hinges(const Body& body) {
    return std::ranges::any_of(body.terms,
                               [](const Term& term) { return std::holds_alternative<Bending>(term); });
}

std::vector<std::vector<OwnHinge>> own_hinges(const Body& body) {
    std::vector<std::vector<OwnHinge>> lists(body.count());
    for (const Term& term : body.terms) {
        const auto* bending = std::get_if<Bending>(&term);
        if (!bending) continue;
        for (const Hinge& hinge : bending->hinges) {
            const auto& [from, to, left, right, stiffness, rest] = hinge;
            const float square =
                std::max(std::min(area_square(body, from, to, left), area_square(body, to, from, right)),
                         std::numeric_limits<float>::min());
            lists[std::size_t(from)].push_back({true, {to, left, right}, stiffness, rest, square});
            lists[std::size_t(to)].push_back({true, {from, right, left}, stiffness, rest, square});
            lists[std::size_t(left)].push_back({false, {from, to, right}, stiffness, rest, square});
            lists[std::size_t(right)].push_back({false, {to, from, left}, stiffness, rest, square});
        }
    }
    return lists;
}

const TissueCells* tissue_of(const Body& body) {
    for (const Term& term : body.terms)
        if (const auto* cells = std::get_if<TissueCells>(&term)) return cells;
    return nullptr;
}

std::vector<OwnCells> own_cells(const Body& body) {
    OwnCells none;
    none.fill(-1);
    std::vector<OwnCells> own(body.count(), none);
    for (std::size_t c = 0; c < body.cells.size(); ++c)
        for (std::size_t k = 0; k < 8; ++k) own[std::size_t(body.cells[c][k])][k] = int(c);
    return own;
}

Body without_grid(Body body) {
    const Table springs = table(body);
    if (body.grid() && body.fan > 0) {
        for (std::size_t i = 0; i < body.count(); ++i)
            for (int k = 0; k < body.fan; ++k) body.rings.push_back(springs.of(i)[std::size_t(k)].to);
    }
    ListedSprings listed;
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i))
            if (tie.to > int(i) && tie.share > 0)
                listed.springs.push_back({int(i), tie.to, tie.share * tie.stiffness, tie.rest});
    std::erase_if(body.terms, [](const Term& term) { return !std::holds_alternative<Bending>(term); });
    body.terms.insert(body.terms.begin(), std::move(listed));
    body.at.clear();
    body.cells.clear();
    return body;
}

std::vector<uvec2> spring_ends(const Body& body) {
    std::vector<uvec2> ends;
    const Table springs = table(body);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i))
            if (tie.to > int(i) && tie.share > 0 && tie.stiffness > 0) ends.push_back({i, tie.to});
    return ends;
}

std::vector<ivec3> cell_places(const Body& body) {
    std::vector<ivec3> places;
    for (const auto& nodes : body.cells) places.push_back(body.at[nodes[0]]);
    return places;
}

mat3 cell_edges(const Body& body) {
    dmat3 sum(0);
    for (const auto& nodes : body.cells) sum += edges_of(nodes, body.positions);
    return body.cells.empty() ? mat3(0) : mat3(sum / double(body.cells.size()));
}

double mass(const Body& body) {
    double sum = 0;
    for (float inverse : body.inverse_mass)
        if (inverse > 0) sum += 1.0 / inverse;
    return sum;
}

std::size_t inverted_cells(const Body& body, std::span<const vec3> positions) {
    check_count(body, positions.size());
    std::size_t inverted = 0;
    for (const auto& nodes : body.cells) {
        const double now = glm::determinant(edges_of(nodes, positions)),
                     rest = glm::determinant(edges_of(nodes, body.positions));
        inverted += !(now * rest > 0);
    }
    return inverted;
}

}  // namespace palpate
