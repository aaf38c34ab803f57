#include "palpate/solver/cpu/body_memory.h"

#include "palpate/body/grid.h"
#include "palpate/body/stencils.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace palpate::cpu {
namespace {

bool follows(const GridSprings& stencil, std::span<const ivec3> offsets) {
    return std::equal(stencil.links.begin(), stencil.links.end(), offsets.begin(), offsets.end(),
                      [](const Link& link, ivec3 offset) { return link.offset == offset; });
}

bool whole(const GridSprings& stencil) {
    for (std::size_t i = 0; i < stencil.shares.size(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l)
            if (stencil.quarters(i, l) % 4 != 0) return false;
    return true;
}

// Each link at rest, if all nodes that have it agree on it; else nothing.
std::vector<vec3> links_at_rest(const Body& body) {
    const GridSprings& stencil = *body.grid();
    const GridIndex number(body.at);
    // Positions that were turned and moved are rounded more than once.
    const float hair =
        1e-5f * body.spacing + 10 * std::numeric_limits<float>::epsilon() * largest_coordinate(body);
    std::vector<vec3> links;
    for (std::size_t l = 0; l < stencil.links.size(); ++l) {
        dvec3 sum(0);
        std::vector<vec3> seen;
        for (std::size_t i = 0; i < body.count(); ++i) {
            const int to = number.at(body.at[i] + stencil.links[l].offset);
            if (to >= 0) seen.push_back(body.positions[std::size_t(to)] - body.positions[i]);
        }
        for (vec3 v : seen) sum += dvec3(v);
        const vec3 mean =
            seen.empty() ? body.spacing * vec3(stencil.links[l].offset) : vec3(sum / double(seen.size()));
        for (vec3 v : seen)
            if (!(glm::distance(v, mean) <= hair)) return {};
        links.push_back(mean);
    }
    return links;
}

bool along_axes(const Body& body, const std::vector<vec3>& links) {
    for (std::size_t l = 0; l < links.size(); ++l)
        if (!(glm::distance(links[l], body.spacing * vec3(body.grid()->links[l].offset)) <=
              1e-4f * body.spacing))
            return false;
    return true;
}

// Whether a grid's springs and the cells of tissue between them are all that a body has, and the springs pull
// at nothing.
bool is_tissue_alone(const Body& body) {
    return body.terms.size() == 2 && body.grid() && tissue_of(body) &&
           std::ranges::all_of(body.grid()->links, [](const Link& link) { return link.stiffness == 0; });
}

// The kernel for a body's springs, and for those of a grid its links at rest.
std::pair<Springs, std::vector<vec3>> springs_of(const Body& body) {
    const bool cells = is_tissue_alone(body);
    const GridSprings* stencil = body.terms.size() == 1 || cells ? body.grid() : nullptr;
    if (!stencil || body.count() == 0) return {Springs::table, {}};
    std::vector<vec3> links = links_at_rest(body);
    if (links.empty()) return {Springs::table, {}};
    const bool straight = along_axes(body, links), even = stencil->strength.empty();
    Springs springs = Springs::table;
    const bool is_lattice = follows(*stencil, std::span(volume_links).first(lattice_links));
    if (cells) return {is_lattice ? Springs::tissue : Springs::table, std::move(links)};
    if (is_lattice)
        springs = !straight         ? Springs::turned_lattice
                  : !even           ? Springs::lattice_with_strength
                  : whole(*stencil) ? Springs::lattice_whole
                                    : Springs::lattice;
    if (follows(*stencil, volume_links)) springs = straight ? Springs::volume : Springs::turned_volume;
    if (follows(*stencil, cloth_links) && whole(*stencil))
        springs = straight && even ? Springs::cloth : Springs::turned_cloth;
    return {springs, std::move(links)};
}

bool in_quarters(Springs springs) {
    return springs == Springs::lattice || springs == Springs::lattice_with_strength ||
           springs == Springs::turned_lattice || springs == Springs::tissue;
}

// Slots, from a node back to the first in the rows beside it whose cells hold it too.
int reach_of_cells(const Layout& layout) {
    constexpr std::size_t back = lattice_links + 7, links = back + 3;
    int reach = 0;
    for (std::size_t at = 0; at < layout.offsets.size(); at += links)
        for (std::size_t row = 0; row < 3; ++row) reach = std::max(reach, -layout.offsets[at + back + row]);
    return reach;
}

// The cells of a table's nodes, as a kernel's CellRecord: eight for each register of nodes. A cell that is
// not there has the node itself at its corners, and no weight.
Array<std::uint32_t> cell_records(const Body& body, const Layout& layout, int lanes) {
    constexpr std::size_t numbers = 9;
    const auto width = std::size_t(lanes);
    Array<std::uint32_t> records(std::size_t(layout.slots) * 8 * numbers, 0);
    const std::vector<OwnCells> cells = own_cells(body);
    auto number = [&](std::size_t slot, std::size_t k, std::size_t n) -> std::uint32_t& {
        return records.data()[((slot / width * 8 + k) * numbers + n) * width + slot % width];
    };
    for (std::size_t slot = 0; slot < std::size_t(layout.slots); ++slot)
        for (std::size_t k = 0; k < 8; ++k)
            for (std::size_t c = 0; c < 8; ++c) number(slot, k, c) = std::uint32_t(4 * slot);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t k = 0; k < 8; ++k) {
            const auto slot = std::size_t(layout.slot[i]);
            if (cells[i][k] < 0) continue;
            const auto cell = std::size_t(cells[i][k]);
            for (std::size_t c = 0; c < 8; ++c)
                number(slot, k, c) = std::uint32_t(4 * layout.slot[std::size_t(body.cells[cell][c])]);
            number(slot, k, 8) = std::bit_cast<std::uint32_t>(tissue_of(body)->weights[cell]);
        }
    return records;
}

Layout layout_for(const Body& body, Springs springs, int lanes) {
    return springs == Springs::table ? Layout(order_for(table(body), body.count(), body.fan), lanes)
                                     : Layout(body, lanes);
}

}  // namespace

BodyMemory::BodyMemory(const Body& body, const Simulation& simulation, int lanes)
    : BodyMemory(body, simulation, lanes, springs_of(body)) {}

BodyMemory::BodyMemory(const Body& body, const Simulation& simulation, int lanes,
                       const std::pair<Springs, std::vector<vec3>>& springs)
    : layout_(layout_for(body, springs.first, lanes)),
      damped_(body.link_damping > 0),
      corners_(polygon_corners(simulation)),
      fields_(distance_fields(simulation)) {
    view_.springs = springs.first;
    view_.spacing = body.spacing;
    view_.finest = std::exp2(float(std::ilogb(std::max(largest_coordinate(body), 1e-30f)) + 1 - 51));
    std::copy(springs.second.begin(), springs.second.end(), view_.along.begin());
    if (view_.springs == Springs::table) {
        ties_.emplace(body, layout_, lanes);
        bytes_ += ties_->bytes();
        view_.ties = ties_->view();
        view_.whole_within = ties_->whole_within();
        if (has_hinges(body)) {
            hinges_.emplace(body, layout_, lanes);
            bytes_ += hinges_->bytes();
            view_.hinges = hinges_->view();
        }
        if (tissue_of(body)) {
            if (!hinges_) hinges_.emplace(body, layout_, lanes);
            view_.hinges = hinges_->view();
            words_.push_back(cell_records(body, layout_, lanes));
            bytes_ += words_.back().bytes();
            view_.cells.records = words_.back().data();
        }
    } else {
        write_grid(body);
        if (view_.springs == Springs::tissue) {
            cell_weights_ = keep();
            view_.cells.weights = cell_weights_;
            view_.cells.reach = reach_of_cells(layout_);
            const std::vector<OwnCells> cells = own_cells(body);
            for (std::size_t i = 0; i < body.count(); ++i) write_cells(body, cells[i], i);
        }
    }
    for (int axis = 0; axis < 3; ++axis)
        view_.cells.axes[axis] = cell_edges(body) / body.spacing * vec3(layout_.corner(1 << axis));
    bound_blocks(body);
    view_.runs = layout_.runs.data();
    view_.blocks = layout_.blocks.data();
    view_.rest_bounds = rest_bounds_.data();
    view_.furthest_cover = furthest_cover_.data();
    view_.offsets = layout_.offsets.data();
    view_.inverse_mass = inverse_mass_ = spread(body.inverse_mass);
    // Slots without a node: no tip may find one there, as it finds the inner nodes of tissue.
    const bool cells = tissue_of(body) != nullptr;
    view_.area = area_ = spread(body.area, cells ? std::numeric_limits<float>::min() : 0);
    view_.cover = cover_ = spread(body.cover, cells ? -1e9f : 0);
    float* rest[3] = {keep(), keep(), keep()};
    for (std::size_t i = 0; i < body.count(); ++i)
        for (int k = 0; k < 3; ++k) rest[k][layout_.slot[i]] = body.positions[i][k];
    view_.rest_x = rest[0], view_.rest_y = rest[1], view_.rest_z = rest[2];
    view_.corners = corners_.data();
    view_.fields = fields_.data();
}

void BodyMemory::write_grid(const Body& body) {
    const GridSprings& stencil = *body.grid();
    const bool quarters = in_quarters(view_.springs);
    for (int w = 0; w < (quarters ? 2 : 1); ++w) {
        words_.emplace_back(layout_, arrays_++);
        bytes_ += words_.back().bytes();
        view_.words[w] = words_.back().data();
    }
    for (std::size_t i = 0; i < body.count(); ++i) write_shares(body, i);
    view_.whole_within = std::numeric_limits<float>::max();
    for (std::size_t l = 0; l < stencil.links.size(); ++l)
        view_.whole_within =
            std::min(view_.whole_within, whole_within(torn_at(stencil.links[l].rest, body), view_.along[l]));
    std::vector<float> half(body.count(), 0.5f);
    for (std::size_t i = 0; i < stencil.strength.size(); ++i) half[i] *= stencil.strength[i];
    const bool varies = view_.springs == Springs::lattice_with_strength ||
                        view_.springs == Springs::turned_lattice || view_.springs == Springs::turned_cloth ||
                        view_.springs == Springs::volume || view_.springs == Springs::turned_volume;
    if (varies) view_.half_strength = spread(half);
}

void BodyMemory::add_neighbour_arrays(Fields& state) {
    if (!ties_) return;
    auto four_a_slot = [&] {
        floats_.emplace_back(4 * std::size_t(layout_.slots), arrays_++);
        bytes_ += floats_.back().bytes();
        return floats_.back().data();
    };
    state.places = four_a_slot();
    if (damped_) state.speeds = four_a_slot();
}

void BodyMemory::write_shares(const Body& body, std::size_t node) {
    const GridSprings& stencil = *body.grid();
    const bool quarters = in_quarters(view_.springs);
    const std::size_t per_word = quarters ? 10 : 32;
    const int slot = layout_.slot[node];
    for (auto& word : words_) word.data()[slot] = 0;
    for (std::size_t l = 0; l < stencil.links.size(); ++l) {
        const unsigned share = unsigned(stencil.quarters(node, l)), bit = unsigned(l % per_word);
        words_[l / per_word].data()[slot] |= quarters ? share << 3 * bit : share / 4 << bit;
    }
}

void BodyMemory::write_cells(const Body& body, const OwnCells& cells, std::size_t node) {
    const int slot = layout_.slot[node];
    cell_weights_[slot] = cells[0] < 0 ? 0 : tissue_of(body)->weights[std::size_t(cells[0])];
    for (int k = 0; k < 8; ++k) {
        const ivec3 c = layout_.corner(k);
        if (cells[std::size_t(c.x + 2 * c.y + 4 * c.z)] >= 0) words_[1].data()[slot] |= 1u << (24 + k / 2);
    }
}

bool BodyMemory::change(const Body& body, std::span<const int> nodes) {
    const bool cells = view_.springs == Springs::tissue;
    if (view_.springs == Springs::table || body.terms.size() != (cells ? 2 : 1)) return false;
    if (!in_quarters(view_.springs) && !whole(*body.grid())) return false;
    const std::vector<OwnCells> own = cells ? own_cells(body) : std::vector<OwnCells>();
    for (int node : nodes) {
        const auto i = std::size_t(node);
        const int slot = layout_.slot[i];
        write_shares(body, i);
        if (cells) write_cells(body, own[i], i);
        inverse_mass_[slot] = body.inverse_mass[i];
        area_[slot] = body.area[i];
        cover_[slot] = body.cover[i];
    }
    bound_blocks(body);
    view_.rest_bounds = rest_bounds_.data();
    view_.furthest_cover = furthest_cover_.data();
    return true;
}

void BodyMemory::bound_blocks(const Body& body) {
    rest_bounds_.assign(layout_.blocks.size(), {});
    furthest_cover_.assign(layout_.blocks.size(), 0);
    for (std::size_t i = 0; i < body.count(); ++i) {
        const auto after =
            std::upper_bound(layout_.blocks.begin(), layout_.blocks.end(), layout_.slot[i],
                             [](int slot, const Block& block) { return slot < block.first_slot; });
        const auto block = std::size_t(after - layout_.blocks.begin()) - 1;
        rest_bounds_[block].include(body.positions[i]);
        furthest_cover_[block] = std::max(furthest_cover_[block], body.cover[i]);
    }
}

float* BodyMemory::keep() {
    floats_.push_back(array());
    bytes_ += floats_.back().bytes();
    return floats_.back().data();
}

float* BodyMemory::spread(const std::vector<float>& of_nodes, float elsewhere) {
    float* to = keep();
    std::fill_n(to, layout_.slots, elsewhere);
    for (std::size_t i = 0; i < of_nodes.size(); ++i) to[layout_.slot[i]] = of_nodes[i];
    return to;
}

}  // namespace palpate::cpu
