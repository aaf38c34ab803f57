#include "palpate/body/edit.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"
#include "palpate/body/hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace palpate {
namespace {

void check_edit(const Body& body, const Edit& edit) {
    for (uvec2 link : edit.links)
        if (std::max(link.x, link.y) >= body.count())
            throw Error(fmt::format("a link between nodes {} and {} of {}", link.x, link.y, body.count()),
                        name_in_errors(body), "count nodes from 0");
    for (int cell : edit.cells)
        if (cell < 0 || std::size_t(cell) >= body.cells.size())
            throw Error(fmt::format("cell {} of {}", cell, body.cells.size()), name_in_errors(body),
                        "count cells from 0");
}

// The grid of a body while springs and cells are cut out of it.
class Cutting {
 public:
    explicit Cutting(Body& body)
        : body_(body), node_at_(body.at), filled_(body.at.empty() ? ivec3(0) : node_at_.low, node_at_.dims) {
        const std::vector<ivec3> places = cell_places(body);
        for (std::size_t c = 0; c < places.size(); ++c) filled_[places[c]] = int(c);
    }

    void cut_link(int a, int b) {
        cut_.insert(std::minmax(a, b));
        if (GridSprings* grid = body_.grid()) {
            const ivec3 way = body_.at[std::size_t(b)] - body_.at[std::size_t(a)];
            for (std::size_t l = 0; l < grid->links.size(); ++l) {
                if (grid->links[l].offset == way) grid->set_quarters(std::size_t(a), l, 0);
                if (grid->links[l].offset == -way) grid->set_quarters(std::size_t(b), l, 0);
            }
        }
        for (Term& term : body_.terms)
            if (auto* listed = std::get_if<ListedSprings>(&term))
                std::erase_if(listed->springs, [&](const Spring& s) {
                    return (s.a == a && s.b == b) || (s.a == b && s.b == a);
                });
    }

    void take_cell(int cell) {
        const auto nodes = body_.cells[std::size_t(cell)];
        const ivec3 place = body_.at[std::size_t(nodes[0])];
        filled_[place] = -1;
        GridSprings* grid = body_.grid();
        for (std::size_t l = 0; grid && l < grid->links.size(); ++l)
            for (int node : nodes) weaken(*grid, std::size_t(node), l, place);
    }

    // The hinges of triangles of which an edge was cut go last. Their nodes.
    std::set<int> cut_hinges() {
        std::set<int> nodes;
        auto is_cut = [&](const Hinge& hinge) {
            const auto& [from, to, left, right, stiffness, rest] = hinge;
            for (const auto& [a, b] :
                 {std::pair(from, to), {to, left}, {left, from}, {to, right}, {right, from}})
                if (cut_.contains(std::minmax(a, b))) {
                    nodes.insert({from, to, left, right});
                    return true;
                }
            return false;
        };
        for (Term& term : body_.terms)
            if (auto* bending = std::get_if<Bending>(&term)) std::erase_if(bending->hinges, is_cut);
        return nodes;
    }

 private:
    // A link of a corner of a cell that has just gone, if it is beside it.
    void weaken(GridSprings& grid, std::size_t node, std::size_t link, ivec3 gone) {
        const int share = grid.quarters(node, link);
        const ivec3 offset = grid.links[link].offset, from = body_.at[node];
        const ivec3 low = glm::min(from, from + offset), high = glm::max(from, from + offset);
        const ivec3 length = high - low;
        if (share == 0 || glm::any(glm::lessThan(low, gone)) || glm::any(glm::greaterThan(high, gone + 1)))
            return;
        int left = 0, beside = 0;  // of the cells around the link
        const ivec3 first = high - 1;
        for (ivec3 c = first; c.z <= low.z; ++c.z)
            for (c.y = first.y; c.y <= low.y; ++c.y)
                for (c.x = first.x; c.x <= low.x; ++c.x) {
                    left += filled_.at(c) >= 0;
                    beside += 1;
                }
        const int whole = length.x + length.y + length.z == 1 ? 4 : 2;
        const bool by_cells = share == std::min(4, (left + 1) * 4 / whole);
        const int now = left == 0 ? 0 : by_cells && beside <= whole ? left * 4 / whole : share;
        set_both(grid, node, link, now);
        if (now == 0 && glm::dot(vec3(offset), vec3(offset)) < 1.5f) cut_flexion_over(grid, node, offset);
    }

    void set_both(GridSprings& grid, std::size_t node, std::size_t link, int quarters) {
        const ivec3 offset = grid.links[link].offset;
        grid.set_quarters(node, link, quarters);
        const int other = node_at_.at(body_.at[node] + offset);
        if (quarters == 0 && other >= 0) cut_.insert(std::minmax(int(node), other));
        for (std::size_t l = 0; l < grid.links.size(); ++l)
            if (other >= 0 && grid.links[l].offset == -offset)
                grid.set_quarters(std::size_t(other), l, quarters);
    }

    // The flexion springs that pass over a link along an axis go with it.
    void cut_flexion_over(GridSprings& grid, std::size_t node, ivec3 offset) {
        for (std::size_t l = 0; l < grid.links.size(); ++l) {
            if (grid.links[l].offset != 2 * offset) continue;
            set_both(grid, node, l, 0);
            const int before = node_at_.at(body_.at[node] - offset);
            if (before >= 0) set_both(grid, std::size_t(before), l, 0);
        }
    }

    Body& body_;
    const GridIndex node_at_;
    GridIndex filled_;
    std::set<std::pair<int, int>> cut_;  // between which nodes, the lower first
};

// How much of the cells around each node is filled.
std::vector<double> filled_around(const Body& body) {
    const TissueCells* cells = tissue_of(body);
    std::vector<double> filled(body.count(), 0);
    for (std::size_t c = 0; c < body.cells.size(); ++c)
        for (int node : body.cells[c]) filled[std::size_t(node)] += cells ? double(cells->filled[c]) : 1;
    return filled;
}

std::vector<char> held_by_listed_springs(const Body& body) {
    std::vector<char> held(body.count(), 0);
    for (const Term& term : body.terms)
        if (const auto* listed = std::get_if<ListedSprings>(&term))
            for (const Spring& s : listed->springs) held[std::size_t(s.a)] = held[std::size_t(s.b)] = 1;
    return held;
}

template <class T>
void keep(std::vector<T>& list, const std::vector<int>& kept, std::size_t each = 1) {
    if (list.empty()) return;
    std::vector<T> left;
    for (int i : kept)
        for (std::size_t k = 0; k < each; ++k) left.push_back(list[std::size_t(i) * each + k]);
    list = std::move(left);
}

// Only these nodes are left, in this order.
void keep_nodes(Body& body, const std::vector<int>& kept) {
    std::vector<int> number(body.count(), -1);
    for (std::size_t i = 0; i < kept.size(); ++i) number[std::size_t(kept[i])] = int(i);
    keep(body.rings, kept, std::size_t(body.fan));
    for (int& node : body.rings)
        if (node >= 0) node = number[std::size_t(node)];
    keep(body.positions, kept);
    keep(body.inverse_mass, kept);
    keep(body.area, kept);
    keep(body.cover, kept);
    keep(body.at, kept);
    for (Term& term : body.terms)
        if (auto* grid = std::get_if<GridSprings>(&term)) {
            keep(grid->shares, kept);
            keep(grid->strength, kept);
        } else if (auto* listed = std::get_if<ListedSprings>(&term)) {
            for (Spring& s : listed->springs) s.a = number[std::size_t(s.a)], s.b = number[std::size_t(s.b)];
        } else if (auto* bending = std::get_if<Bending>(&term)) {
            std::erase_if(bending->hinges, [&](Hinge& hinge) {
                bool is_whole = true;
                for (int* node : {&hinge.from, &hinge.to, &hinge.left, &hinge.right})
                    is_whole = (*node = number[std::size_t(*node)]) >= 0 && is_whole;
                return !is_whole;
            });
        }
    for (auto& cell : body.cells)
        for (int& node : cell) node = number[std::size_t(node)];
    std::erase_if(body.faces, [&](auto& face) {
        for (int& node : face) node = number[std::size_t(node)];
        return std::ranges::min(face) < 0;
    });
}

}  // namespace

BodyChange apply(Body& body, const Edit& edit) {
    check_edit(body, edit);
    BodyChange change;
    change.nodes_before = body.count();
    std::set<int> touched;
    const std::vector<double> filled_before = filled_around(body);
    {
        Cutting cutting(body);
        for (uvec2 link : edit.links) {
            cutting.cut_link(int(link.x), int(link.y));
            touched.insert({int(link.x), int(link.y)});
        }
        const std::set<int> gone(edit.cells.begin(), edit.cells.end());
        for (int cell : gone) {
            const auto& nodes = body.cells[std::size_t(cell)];
            change.cells_gone.push_back({nodes, body.at[std::size_t(nodes[0])]});
            cutting.take_cell(cell);
            touched.insert(nodes.begin(), nodes.end());
        }
        for (int c = 0; c < int(body.cells.size()); ++c)
            if (!gone.contains(c)) change.cell_before.push_back(c);
        keep(body.cells, change.cell_before);
        for (Term& term : body.terms)
            if (auto* tissue = std::get_if<TissueCells>(&term)) {
                keep(tissue->filled, change.cell_before);
                keep(tissue->weights, change.cell_before);
            }
        touched.merge(cutting.cut_hinges());
    }
    const std::vector<double> filled_now = filled_around(body);
    const std::vector<char> held = held_by_listed_springs(body);
    for (int i = 0; i < int(body.count()); ++i) {
        const double before = filled_before[std::size_t(i)], now = filled_now[std::size_t(i)];
        if (now > 0 && now < before) body.inverse_mass[std::size_t(i)] *= float(before / now);
        if (before == 0 || now > 0 || held[std::size_t(i)]) change.node_before.push_back(i);
    }
    if (!change.cells_gone.empty()) {
        const std::vector<float> area = body.area;
        spread_area(body);
        for (int node : touched)
            if (area[std::size_t(node)] == 0 && body.area[std::size_t(node)] > 0)
                body.cover[std::size_t(node)] = 0;
    }
    for (int i = 0; i < int(change.node_before.size()); ++i)
        if (touched.contains(change.node_before[std::size_t(i)])) change.nodes.push_back(i);
    if (!change.same_nodes()) keep_nodes(body, change.node_before);
    return change;
}

namespace {

// The nearest of a body's cells to a place in its grid.
class CellSearch {
 public:
    explicit CellSearch(const Body& body) : body_(body), places_(cell_places(body)), cell_at_(places_) {}

    int of(vec3 place) const {
        const ivec3 middle(glm::floor(place));
        int best = -1;
        float least = std::numeric_limits<float>::max();
        const ivec3 far =
            glm::max(glm::abs(middle - cell_at_.low), glm::abs(middle - cell_at_.low - cell_at_.dims));
        const int last = std::max({far.x, far.y, far.z}) + 1;
        for (int reach = 0; reach <= last && float(reach - 1) < least; ++reach)
            for_each_place(ivec3(2 * reach + 1), [&](ivec3 p) {
                p -= reach;
                if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) != reach) return;
                const int cell = cell_at_.at(middle + p);
                if (cell < 0) return;
                const vec3 low(middle + p),
                    off = glm::max(glm::max(low - place, place - low - 1.0f), vec3(0));
                if (const float distance = glm::length(off); distance < least) least = distance, best = cell;
            });
        return best;
    }
    ivec3 place(int cell) const { return places_[std::size_t(cell)]; }
    const std::array<int, 8>& nodes(int cell) const { return body_.cells[std::size_t(cell)]; }

 private:
    const Body& body_;
    std::vector<ivec3> places_;
    GridIndex cell_at_;
};

bool rehang_all(std::vector<InCell>& vertices, const Body& body, const BodyChange& change,
                const std::vector<int>& number) {
    std::map<std::array<int, 8>, ivec3> gone;
    for (const BodyChange::Gone& cell : change.cells_gone) gone[cell.nodes] = cell.place;
    if (body.cells.empty()) return vertices.empty();
    const CellSearch nearest(body);
    for (InCell& vertex : vertices) {
        if (const auto found = gone.find(vertex.nodes); found != gone.end()) {
            const vec3 place = vec3(found->second) + vertex.at;
            const int cell = nearest.of(place);
            vertex.at = place - vec3(nearest.place(cell));
            vertex.nodes = nearest.nodes(cell);
        } else {
            for (int& node : vertex.nodes) node = number[std::size_t(node)];
        }
    }
    return true;
}

bool rehang_all(std::vector<OnTriangle>& vertices, const Body&, const BodyChange&,
                const std::vector<int>& number) {
    for (OnTriangle& vertex : vertices)
        for (int& node : vertex.nodes)
            if ((node = number[std::size_t(node)]) < 0) return false;
    return true;
}

bool rehang_all(Framed& framed, const Body&, const BodyChange& change, const std::vector<int>&) {
    return framed.vertices.empty() || (change.same_nodes() && change.nodes.empty());
}

}  // namespace

bool rehang(Embedding& embedding, const Body& body, const BodyChange& change) {
    if (embedding.nodes != change.nodes_before)
        throw Error(fmt::format("a surface that hangs on {} nodes instead of {}", embedding.nodes,
                                change.nodes_before),
                    name_in_errors(body), "hang it again after each change");
    std::vector<int> number(change.nodes_before, -1);
    for (std::size_t i = 0; i < change.node_before.size(); ++i)
        number[std::size_t(change.node_before[i])] = int(i);
    Embedding again = embedding;
    if (!std::visit([&](auto& vertices) { return rehang_all(vertices, body, change, number); },
                    again.vertices))
        return false;
    again.nodes = body.count();
    embedding = std::move(again);
    return true;
}

}  // namespace palpate
