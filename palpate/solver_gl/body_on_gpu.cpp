#include "palpate/solver_gl/body_on_gpu.h"

#include "palpate/solver/schedule.h"
#include "palpate/solver_gl/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace palpate::gpu {
namespace {

const char* pass_inl =
#include "embedded/pass.inl.h"
    ;
const char* node_inl =
#include "embedded/node.inl.h"
    ;
const char* obstacles_inl =
#include "embedded/obstacles.inl.h"
    ;
const char* bindings_inl =
#include "embedded/bindings.inl.h"
    ;
const char* prelude_glsl =
#include "embedded/prelude.glsl.h"
    ;
const char* node_access_glsl =
#include "embedded/node_access.glsl.h"
    ;
const char* pass_node_glsl =
#include "embedded/pass_node.glsl.h"
    ;

template <class Value>
gl::Field field(GLenum format, const std::vector<Value>& values) {
    return gl::Field(format, sizeof(Value), values.size(), 0, std::as_bytes(std::span(values)));
}

// In a field that is replaced by a larger one where there is no room.
void put(std::optional<gl::Field>& to, const std::vector<vec4>& values) {
    const std::size_t bytes = values.size() * sizeof(vec4);
    if (!to || to->bytes() < bytes)
        to = field(GL_RGBA32F, values);
    else
        to->put(std::as_bytes(std::span(values)));
}

// Shares in two words, and the outside.
uvec4 traits_of(const Body& body, bool in_grid, std::size_t node) {
    uvec4 trait(0, 0, std::bit_cast<unsigned>(body.area[node]), std::bit_cast<unsigned>(body.cover[node]));
    const GridSprings* stencil = in_grid ? body.grid() : nullptr;
    for (std::size_t l = 0; stencil && l < stencil->links.size(); ++l) {
        const auto quarters = unsigned(stencil->quarters(node, l));
        if (stencil->in_quarters())
            trait[l < 10 ? 0 : 1] |= quarters << 3 * (l % 10);
        else
            trait.x |= quarters / 4 << l;
    }
    return trait;
}

std::vector<uvec4> all_traits(const Body& body, const Placement& placement) {
    std::vector<uvec4> traits(std::size_t(placement.slots), uvec4(0));
    for (std::size_t i = 0; i < body.count(); ++i)
        traits[std::size_t(placement.slot[i])] = traits_of(body, placement.grid, i);
    return traits;
}

int most_hinges(const std::vector<std::vector<OwnHinge>>& hinges) {
    std::size_t most = 0;
    for (const auto& own : hinges) most = std::max(most, own.size());
    return int(most);
}

// Behind the springs: a texture unit of their own would be the seventeenth of a stage, and OpenGL promises
// sixteen.
void add_hinges(std::vector<vec4>& ties, const std::vector<std::vector<OwnHinge>>& hinges) {
    for (int h = 0; h < most_hinges(hinges); ++h)
        for (const bool others : {true, false})
            for (std::size_t i = 0; i < hinges.size(); ++i) {
                const int self = int(i);
                const bool is_there = std::size_t(h) < hinges[i].size();
                const OwnHinge own =
                    is_there ? hinges[i][std::size_t(h)] : OwnHinge{false, {self, self, self}, 0, 0, 1};
                auto at = [&](std::size_t n) { return std::bit_cast<float>(own.others[n]); };
                ties.push_back(others ? vec4(at(0), at(1), at(2), own.is_end ? 1 : 0)
                                      : vec4(own.stiffness, own.rest, own.area_square, 0));
            }
}

void add_cells(std::vector<vec4>& ties, const Body& body) {
    const TissueCells* cells = tissue_of(body);
    if (!cells) return;
    auto four = [](const std::array<int, 8>& all, int first, int add) {
        vec4 some;
        for (int k = 0; k < 4; ++k) some[k] = std::bit_cast<float>(all[std::size_t(first + k)] + add);
        return some;
    };
    const std::vector<OwnCells> own = own_cells(body);
    for (int first : {0, 4})
        for (const OwnCells& of_node : own) ties.push_back(four(of_node, first, 1));
    for (std::size_t c = 0; c < body.cells.size(); ++c)
        ties.insert(ties.end(),
                    {four(body.cells[c], 0, 0), four(body.cells[c], 4, 0), vec4(cells->weights[c], 0, 0, 0)});
}

// Springs written out, those of each link together, so that neighbouring nodes read side by side.
gl::Field ties_of(const Body& body, const Placement& placement) {
    if (placement.grid) {
        std::vector<float> strength(std::size_t(placement.slots), 1.0f);
        const auto& given = body.grid()->strength;
        for (std::size_t i = 0; i < given.size(); ++i) strength[std::size_t(placement.slot[i])] = given[i];
        return field(GL_R32F, given.empty() ? std::vector<float>() : strength);
    }
    const Table springs = table(body);
    std::vector<vec4> ties;
    for (int l = 0; l < springs.width; ++l)
        for (std::size_t i = 0; i < body.count(); ++i) {
            const Tie& tie = springs.of(i)[std::size_t(l)];
            const int to = tie.to < 0 ? int(i) : tie.to;  // where there is none it pulls at nothing
            ties.emplace_back(std::bit_cast<float>(to), tie.share, tie.stiffness, tie.rest);
        }
    add_hinges(ties, own_hinges(body));
    add_cells(ties, body);
    return field(GL_RGBA32F, ties);
}

std::vector<float> all_distances(const Simulation& simulation) {
    std::vector<float> all;
    for (const DistanceField* one : distance_fields(simulation))
        all.insert(all.end(), one->distance.begin(), one->distance.end());
    return all;
}

// The grids of fields, and behind them the corners of polygons.
std::vector<vec4> obstacles_of(const Simulation& simulation) {
    std::vector<vec4> all;
    int first = 0;
    for (const DistanceField* one : distance_fields(simulation)) {
        all.emplace_back(one->origin, one->spacing);
        all.push_back(std::bit_cast<vec4>(ivec4(one->dims, first)));
        first += int(one->distance.size());
    }
    for (vec3 corner : polygon_corners(simulation)) all.emplace_back(corner, 0);
    return all;
}

std::vector<int> number_guides(const Body& body) {
    std::vector<int> numbers;
    int next = 0;
    for (float inverse : body.inverse_mass) numbers.push_back(inverse > 0 ? -1 : next++);
    return numbers;
}

std::size_t count_guides(const Body& body) {
    return std::size_t(
        std::count_if(body.inverse_mass.begin(), body.inverse_mass.end(), [](float m) { return !(m > 0); }));
}

// A stencil's links as constants, which a compiler folds into the loops over them: in a uniform block they
// cost a cloth as much again.
std::string links_of(const Pass& pass, const Placement& placement) {
    const auto links = std::size_t(pass.links);
    auto constant = [&](const char* type, const char* name, auto value) {
        std::string list;
        for (std::size_t l = 0; l < links; ++l) list += fmt::format("{}{}", l > 0 ? ", " : "", value(l));
        return fmt::format("const {0} {1}[LINKS] = {0}[LINKS]({2});\n", type, name, list);
    };
    auto number = [](float value) { return fmt::format("{:.9e}", value); };
    return constant("int", "link_offset", [&](std::size_t l) { return placement.offsets[l]; }) +
           constant("float", "link_stiffness",
                    [&](std::size_t l) { return number(pass.spring[l].stiffness); }) +
           constant("float", "link_tension", [&](std::size_t l) { return number(pass.spring[l].tension); }) +
           constant("float", "link_longest", [&](std::size_t l) { return number(pass.spring[l].longest); });
}

}  // namespace

Text physics(const Body& body, const Simulation& simulation, const Placement& placement, int width,
             Tools tools, bool tiled) {
    const bool sums = needs(scheme(simulation.integrator), sum);
    std::string text = "#version 450 core\n";
    auto define = [&](bool holds, const std::string& what) {
        if (holds) text += "#define " + what + "\n";
    };
    const GridSprings* stencil = placement.grid ? body.grid() : nullptr;
    const Pass pass = make_pass(body, simulation);
    define(true, fmt::format("LINKS {}", stencil ? pass.links : table(body).width));
    define(true, fmt::format("HINGES {}", stencil ? 0 : most_hinges(own_hinges(body))));
    define(true, fmt::format("CELLS {}", tissue_of(body) ? 8 : 0));
    define(true, fmt::format("FIELDS {}", distance_fields(simulation).size()));
    define(tissue_of(body) && spring_ends(body).empty(), "SPRINGS 0");
    define(!stencil, "TABLE");
    define(stencil && stencil->in_quarters(), "QUARTERS");
    define(stencil && !stencil->strength.empty(), "STRENGTH");
    define(true, fmt::format("SLOTS {}", placement.slots));
    define(true, fmt::format("SPACING {:e}", body.spacing));
    define(sums, "SUMS");
    define(count_guides(body) > 0, "GUIDES");
    define(true, fmt::format("FAN {}", body.fan));
    define(!(body.link_damping > 0), "LINK_DAMPING false");
    define(!(simulation.air > 0), "WIND false");
    define(simulation.colliders.empty(), "OBSTACLES 0");
    define(tools == Tools::none, "TIPS 0");
    define(tools == Tools::none, "PUSHES 0");
    define(tools != Tools::resisting, "RESISTANCE false");
    define(width > 0, fmt::format("FLAT {}", width));
    Text made{{}, sums, placement.slots};
    if (stencil) text += links_of(pass, placement);
    if (tiled && stencil) {
        const Tiles cut = tiles(body, placement);
        text += gpu::text(cut, body, placement);
        made.tiles = cut.groups;
    }
    for (const char* part :
         {bindings_inl, prelude_glsl, pass_inl, node_access_glsl, node_inl, obstacles_inl, pass_node_glsl})
        text += part;
    made.physics = std::move(text);
    return made;
}

BodyOnGpu::BodyOnGpu(const Body& body, const Simulation& simulation, const Placement& placement)
    : traits_of_(all_traits(body, placement)),
      traits_(field(GL_RGBA32UI, traits_of_)),
      ties_(ties_of(body, placement)),
      slots_(field(GL_R32I, placement.slot)),
      rim_(field(GL_R32I, placement.rim)),
      obstacles_(field(GL_RGBA32F, obstacles_of(simulation))),
      distances_(field(GL_R32F, all_distances(simulation))),
      guide_(number_guides(body)),
      guides_(GL_RGBA32F, sizeof(vec4), 2 * count_guides(body), 0),
      uniforms_(gl::Buffer::room(sizeof(Pass))),
      slot_of_(placement.slot),
      push_of_(std::size_t(placement.slots), 0),
      push_of_slots_(field(GL_R32I, push_of_)) {}

bool BodyOnGpu::change(const Body& body, const Placement& placement, std::span<const int> nodes) {
    for (int node : nodes) {
        const bool was_outside = traits_of_[std::size_t(placement.slot[std::size_t(node)])].z != 0;
        if (was_outside != (body.area[std::size_t(node)] > 0)) return false;
    }
    for (int node : nodes)
        traits_of_[std::size_t(placement.slot[std::size_t(node)])] =
            gpu::traits_of(body, placement.grid, std::size_t(node));
    traits_.put(std::as_bytes(std::span(traits_of_)));
    return true;
}

void BodyOnGpu::bind() const {
    traits_.bind(traits_unit);
    ties_.bind(ties_unit);
    guides_.bind(guides_unit);
    obstacles_.bind(obstacles_unit);
    distances_.bind(distances_unit);
    slots_.bind(slots_unit);
    push_of_slots_.bind(push_of_unit);
    for (GLuint unit = 0; unit < units; ++unit) glBindSampler(unit, 0);
    glBindBufferBase(GL_UNIFORM_BUFFER, pass_block, uniforms_.name());
}

void BodyOnGpu::upload(const Pass& pass) const {
    // Mostly only the numbers at the front have changed, or nothing.
    constexpr std::size_t front = offsetof(Pass, obstacle);
    const auto* bytes = reinterpret_cast<const std::byte*>(&pass);
    const auto* known = pass_ ? reinterpret_cast<const std::byte*>(&*pass_) : nullptr;
    if (!known || std::memcmp(bytes + front, known + front, sizeof(Pass) - front) != 0)
        glNamedBufferSubData(uniforms_.name(), 0, sizeof(Pass), bytes);
    else if (std::memcmp(bytes, known, front) != 0)
        glNamedBufferSubData(uniforms_.name(), 0, front, bytes);
    pass_ = pass;
}

void BodyOnGpu::lead(std::span<const Guide> guides) {
    std::vector<vec4> values;
    for (const Guide& guide : guides) {
        values.emplace_back(vec3(guide.velocity), 0);
        values.emplace_back(vec3(guide.to), guide.is_led ? 1 : 0);
    }
    guides_.put(std::as_bytes(std::span(values)));
}

void BodyOnGpu::push(std::span<const NodePush> by_nodes, std::span<const NodePush> given) {
    std::fill(push_of_.begin(), push_of_.end(), 0);
    std::vector<vec4> values;
    auto add = [&](const NodePush& push) {
        const int slot = slot_of_[std::size_t(push.node)];
        values.emplace_back(push.to, push.stiffness);
        values.emplace_back(push.velocity, std::bit_cast<float>(slot));
        values.emplace_back(push.force, 0);
        return slot;
    };
    for (std::size_t p = 0; p < by_nodes.size(); ++p) push_of_[std::size_t(add(by_nodes[p]))] = int(p) + 1;
    for (const NodePush& push : given) add(push);
    push_of_slots_.put(std::as_bytes(std::span(push_of_)));
    put(pushes_, values);
    pushes_->bind(pushes_unit);
}

void BodyOnGpu::place(std::span<const RoundTip> tips) {
    std::vector<vec4> values;
    for (const RoundTip& tip : tips) values.insert(values.end(), {tip.place, tip.push, tip.velocity});
    put(tips_, values);
    tips_->bind(tips_unit);
}

std::size_t BodyOnGpu::bytes() const {
    return traits_.bytes() + ties_.bytes() + slots_.bytes() + rim_.bytes() + guides_.bytes();
}

}  // namespace palpate::gpu
