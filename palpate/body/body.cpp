#include "palpate/body/body.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
    int links = 0;
    if (const auto* stencil = std::get_if<Stencil>(&body.springs)) {
        links = int(stencil->links.size());
        require(links <= 32, "more than 32 links a node", "write its springs out in a Table");
        require(stencil->at.size() == count && stencil->shares.size() == count &&
                    (stencil->strength.empty() || stencil->strength.size() == count),
                "a stencil of another number of nodes", "give every node a place in the grid, and shares");
        require(is_compact(stencil->at), "a grid with two nodes at one place, or in too large a box",
                "give every node a place of its own, with few empty ones between them");
        for (const Link& link : stencil->links)
            require(is_some(link.stiffness) && is_some(link.rest),
                    "a link whose stiffness or length is negative or not finite", "give them in N/m and m");
        require(std::ranges::all_of(stencil->strength, is_some), "a strength that is negative or not finite",
                "use 0 or more");
    } else {
        const Table& written = std::get<Table>(body.springs);
        links = written.width;
        require(links >= 0 && written.ties.size() == count * std::size_t(links),
                "a table of another number of springs",
                "give every node `width` ties, empty ones among them");
        for (const Tie& tie : written.ties)
            require(tie.to == -1 ||
                        (has(tie.to) && is_some(tie.share) && is_some(tie.stiffness) && is_some(tie.rest)),
                    "a spring to a node that it does not have, or whose numbers are negative or not finite",
                    "count nodes from 0; -1 is no spring");
    }
    require(body.fan >= 0 && body.fan <= links, "a fan of more springs than a node has",
            "use as many, or 0 in a solid");
    require(body.cells.empty() || std::holds_alternative<Stencil>(body.springs), "cells without a grid",
            "keep its Stencil, or leave the cells out");
    for (const auto& cell : body.cells)
        require(std::ranges::all_of(cell, has), "a cell of a node that it does not have",
                "count nodes from 0");
    for (const auto& face : body.faces)
        require(std::ranges::all_of(face, has), "a face of a node that it does not have",
                "count nodes from 0");
}

Table table(const Body& body) {
    if (const auto* written = std::get_if<Table>(&body.springs)) return *written;
    const Stencil& stencil = body.stencil();
    const GridIndex node_at(stencil.at);
    Table table{int(stencil.links.size()), {}};
    table.ties.reserve(body.count() * stencil.links.size());
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l) {
            const Link& link = stencil.links[l];
            const int quarters = stencil.quarters(i, l);
            const int to = quarters > 0 ? node_at.at(stencil.at[i] + link.offset) : -1;
            const float strength =
                stencil.strength.empty() || to < 0 ? 1 : 0.5f * (stencil.strength[i] + stencil.strength[to]);
            table.ties.push_back({to, 0.25f * float(quarters), strength * link.stiffness, link.rest});
        }
    return table;
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
    for (const auto& nodes : body.cells) places.push_back(body.stencil().at[nodes[0]]);
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
