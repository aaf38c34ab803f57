#include "palpate/body/lattice.h"

#include "palpate/base/error.h"
#include "palpate/body/cells.h"
#include "palpate/body/grid.h"
#include "palpate/body/hull.h"
#include "palpate/body/stencils.h"
#include "palpate/mesh/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate {
namespace {

constexpr int samples = 4;           // along each edge of a cell, to find how much of it is inside
constexpr double most_cells = 30e6;  // in the box around a body

Link link_to(ivec3 offset, float stiffness, float spacing) {
    return {offset, stiffness, spacing * glm::length(vec3(offset))};
}

std::vector<Link> isotropic_links(const Material& material, float spacing) {
    const float stiffness = is_tissue(material)      ? 0
                            : material.stiffness > 0 ? material.stiffness
                                                     : 0.4f * material.youngs_modulus * spacing;
    std::vector<Link> links;
    for (int l = 0; l < lattice_links; ++l) links.push_back(link_to(volume_links[l], stiffness, spacing));
    return links;
}

std::vector<Link> links_of_kinds(const SpringKinds& stiffness, float spacing) {
    std::vector<Link> links;
    for (ivec3 offset : volume_links) {
        const ivec3 size = glm::abs(offset);
        const bool flexion = std::max({size.x, size.y, size.z}) == 2,
                   structural = size.x + size.y + size.z == 1;
        links.push_back(link_to(offset,
                                flexion      ? stiffness.flexion
                                : structural ? stiffness.structural
                                             : stiffness.shear,
                                spacing));
    }
    return links;
}

// The nodes of a grid that exist: 0 at the corners of filled cells, -1 elsewhere.
GridIndex corners_of(const Cells& cells) {
    GridIndex grid(ivec3(0), cells.dims + 1);
    for_each_place(cells.dims, [&](ivec3 c) {
        if (cells.at(c))
            for (int k = 0; k < 8; ++k) grid[c + cell_corner(k)] = 0;
    });
    return grid;
}

int count(const GridIndex& grid) {
    return int(grid.numbers.size() - std::count(grid.numbers.begin(), grid.numbers.end(), -1));
}

int filled_around(const Cells& cells, ivec3 p) {
    int filled = 0;
    for (int k = 0; k < 8; ++k) filled += cells.at(p - cell_corner(k));
    return filled;
}

// Filled cells that hold both ends of the link from p: of four for a link along an axis, of two for a
// diagonal.
int filled_beside(const Cells& cells, ivec3 p, ivec3 offset) {
    int filled = 0;
    for (int k = 0; k < 8; ++k) {
        const ivec3 cell = p - cell_corner(k), end = p + offset - cell;
        const bool holds =
            glm::all(glm::greaterThanEqual(end, ivec3(0))) && glm::all(glm::lessThanEqual(end, ivec3(1)));
        filled += holds && cells.at(cell);
    }
    return filled;
}

// How much of a link there is, in quarters. Where no cell is filled beside it, it exists only if one of its
// ends belongs to no filled cell at all, and is then as strong as beside a single cell.
int quarters(const Cells& cells, ivec3 p, ivec3 offset) {
    const int whole =
        glm::dot(vec3(offset), vec3(offset)) < 1.5f ? 4 : 2;  // cells around a link inside the body
    const int filled = filled_beside(cells, p, offset);
    const bool thin = filled_around(cells, p) == 0 || filled_around(cells, p + offset) == 0;
    return (filled > 0 ? filled : thin ? 1 : 0) * 4 / whole;
}

bool equal_links(const Material& material) {
    if (is_tissue(material)) return false;
    return material.links == Links::equal ||
           (material.links == Links::automatic && material.youngs_modulus <= 0);
}

// Spreads the mass over the nodes: by how much of the eight cells around each is filled, or evenly.
void weigh(Body& body, const Material& material, bool equal, double volume) {
    std::vector<double> filled(body.count(), 0);
    const TissueCells* cells = tissue_of(body);
    for (std::size_t c = 0; c < body.cells.size(); ++c)
        for (int node : body.cells[c]) filled[std::size_t(node)] += cells ? double(cells->filled[c]) : 1;
    std::vector<double> part(body.count(), 1);
    if (!equal)
        for (std::size_t i = 0; i < body.count(); ++i) part[i] = (filled[i] > 0 ? filled[i] : 1) / 8;
    double parts = 0;
    for (double p : part) parts += p;
    const double total = material.mass > 0 ? material.mass
                         : volume > 0      ? material.density * volume
                                           : material.density * std::pow(body.spacing, 3) * parts;
    // What has no mass no force can move.
    for (std::size_t i = 0; i < body.count(); ++i)
        body.inverse_mass[i] = total > 0 ? float(parts / (total * part[i])) : 0;
}

// One of two numbers must be above zero, the other 0.
bool is_one(float a, float b) { return a >= 0 && b >= 0 && (a > 0) != (b > 0) && std::isfinite(a + b); }

// Nothing is said of it: a cage that is moved by others.
bool is_bare(const Material& material) {
    return material.youngs_modulus == 0 && material.stiffness == 0 && material.density == 0 &&
           material.mass == 0;
}

void check_stiffness(const Material& material) {
    if (!is_one(material.youngs_modulus, material.stiffness))
        throw Error("both a Young's modulus and a stiffness above zero, or none", "the material of a lattice",
                    "give it one of them");
    if (!is_tissue(material)) return;
    if (!(material.youngs_modulus > 0))
        throw Error("tissue without a Young's modulus", "the material of a lattice",
                    "give it one, or make it of springs");
    if (!(material.poisson >= 0 && material.poisson <= 0.499f))
        throw Error(fmt::format("a Poisson's ratio of {}", material.poisson), "the material of a lattice",
                    "use one from 0 to 0.499; most organs have 0.45 to 0.49");
}
void check_mass(const Material& material) {
    if (!is_one(material.density, material.mass))
        throw Error("both a density and a mass above zero, or none", "the material of a lattice",
                    "give it one of them");
}

// Of each filled cell, how much of it is.
std::vector<float> how_full(const Cells& cells) {
    std::vector<float> parts;
    for (std::size_t c = 0; c < cells.filled.size(); ++c)
        if (cells.filled[c]) parts.push_back(cells.parts.empty() ? 1 : cells.parts[c]);
    return parts;
}

// Nodes at the grid's points, the springs between them, and the masses. `equal`: all links are whole, at the
// rim too. `volume`: of the solid, m³; 0 if the cells' own is meant.
Body assemble(GridIndex grid, const Cells& cells, vec3 origin, float spacing, std::vector<Link> links,
              const Material& material, bool equal, double volume) {
    Body body;
    body.spacing = spacing;
    body.damping = material.damping;
    body.link_damping = material.link_damping;
    GridSprings springs{std::move(links), {}, {}};

    for_each_place(grid.dims, [&](ivec3 p) {
        if (grid[p] < 0) return;
        grid[p] = int(body.count());
        body.positions.push_back(origin + spacing * vec3(p));
        body.at.push_back(p);
    });
    const int bits = springs.in_quarters() ? 3 : 1, whole = springs.in_quarters() ? 4 : 1;
    for (ivec3 p : body.at) {
        std::uint64_t shares = 0;
        for (std::size_t l = 0; l < springs.links.size(); ++l)
            if (const ivec3 offset = springs.links[l].offset; grid.at(p + offset) >= 0)
                shares |= std::uint64_t(equal ? whole : quarters(cells, p, offset)) << bits * l;
        springs.shares.push_back(shares);
    }
    body.terms = {std::move(springs)};

    for_each_place(cells.dims, [&](ivec3 c) {
        if (!cells.at(c)) return;
        std::array<int, 8>& nodes = body.cells.emplace_back();
        for (int k = 0; k < 8; ++k) nodes[k] = grid[c + cell_corner(k)];
    });
    if (is_tissue(material) && body.cells.empty())
        throw Error("tissue without a cell", "the lattice",
                    "use 2 nodes or more along each axis, or make it of springs");
    if (is_tissue(material))
        body.terms.push_back(
            TissueCells{material.youngs_modulus, material.poisson, how_full(cells), how_full(cells)});
    body.inverse_mass.resize(body.count());
    weigh(body, material, equal, volume);
    spread_area(body);
    body.cover.assign(body.count(), 0);
    return body;
}

// A box of cells around a mesh, with an empty cell on every side. Its grid starts at the mesh's lowest
// corner, so that a box of whole cells is filled exactly.
struct CellBox {
    vec3 origin;
    ivec3 dims;
};

CellBox frame_around(const Bounds& box, float spacing) {
    const dvec3 cells = glm::ceil(dvec3(box.size()) / double(spacing) - 1e-3) + 2.0;
    if (!(cells.x * cells.y * cells.z <= most_cells))
        throw Error(
            fmt::format("a spacing of {} m would need {:.3g} cells", spacing, cells.x * cells.y * cells.z),
            "the lattice", "use a larger spacing, or fewer nodes");
    return {box.low - spacing, ivec3(cells)};
}

// Cells with their samples, found by place.
struct Sampled {
    CellBox frame;
    float fine;  // m, between points
    std::vector<Samples> cells;

    Sampled(const CellBox& box, float spacing)
        : frame(box), fine(spacing / samples), cells(std::size_t(box.dims.x) * box.dims.y * box.dims.z) {}

    // The word and the bit of a point, by its place among all points.
    Samples& cell_of(ivec3 p) {
        const ivec3 c = p / samples;
        return cells[(std::size_t(c.z) * frame.dims.y + c.y) * frame.dims.x + c.x];
    }
    static std::uint64_t bit_of(ivec3 p) {
        const ivec3 within = p % samples;
        return std::uint64_t(1) << (within.x + samples * (within.y + samples * within.z));
    }
};

void mark_inside(const SignedDistance& distance, Sampled& sampled) {
    const ivec3 dims = sampled.frame.dims * samples, slab(dims.x, dims.y, samples);
    for (int z = 0; z < dims.z; z += samples) {
        const vec3 first = sampled.frame.origin + sampled.fine * (vec3(0.5f) + vec3(0, 0, float(z)));
        const std::vector<float> d = distance.sample(first, sampled.fine, slab);
        std::size_t i = 0;
        for_each_place(slab, [&](ivec3 p) {
            p.z += z;
            if (d[i++] < 0) sampled.cell_of(p).inside |= Sampled::bit_of(p);
        });
    }
}

// How much of each cell is inside the solid. What lies in cells that stay empty is added to the filled ones
// beside them, so that the sum is the solid's volume. Less than an eighth would make nodes of nearly no mass,
// which no contact can hold.
void find_parts(Cells& cells, const std::vector<Samples>& samples_of) {
    for (const Samples& one : samples_of) cells.parts.push_back(float(std::popcount(one.inside)) / 64);
    const std::vector<float> inside = cells.parts;
    for_each_place(cells.dims, [&](ivec3 c) {
        const float part = inside[cells.index(c)];
        if (cells.at(c) || part == 0) return;
        std::vector<std::size_t> beside;
        for (int axis = 0; axis < 3; ++axis)
            for (int side : {-1, 1}) {
                ivec3 other = c;
                other[axis] += side;
                if (cells.at(other)) beside.push_back(cells.index(other));
            }
        for (std::size_t one : beside) cells.parts[one] += part / float(beside.size());
    });
    for (float& part : cells.parts) part = std::max(part, 0.125f);
}

// Marks the points in whose part of their cell the surface lies, by scattering points over each triangle,
// closer together than the parts are wide: in rows across it, from the corner opposite its shortest side.
void mark_surface(const Mesh& mesh, Sampled& sampled) {
    auto steps = [&](float length) { return 1 + int(2 * length / sampled.fine); };
    for (uvec3 t : mesh.triangles) {
        vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const float ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
        if (ab < bc && ab <= ca)
            std::swap(a, c);
        else if (ca < bc)
            std::swap(a, b);
        const int rows = steps(std::max(glm::distance(a, b), glm::distance(a, c)));
        for (int row = 0; row <= rows; ++row) {
            const float part = float(row) / float(rows);
            const vec3 from = glm::mix(a, b, part), to = glm::mix(a, c, part);
            const int points = steps(glm::distance(from, to));
            for (int i = 0; i <= points; ++i) {
                const vec3 point = glm::mix(from, to, float(i) / float(points));
                const ivec3 p((point - sampled.frame.origin) / sampled.fine);
                sampled.cell_of(p).near |= Sampled::bit_of(p);
            }
        }
    }
}

}  // namespace

Body lattice(const Mesh& mesh, const LatticeSettings& settings, const Progress& progress) {
    check(mesh, "the surface of a lattice");
    check_stiffness(settings.material);
    check_mass(settings.material);
    if (!(settings.spacing >= 0 && std::isfinite(settings.spacing)) ||
        (settings.spacing == 0 && settings.nodes < 1))
        throw Error(fmt::format("{} nodes, or a spacing of {} m", settings.nodes, settings.spacing),
                    "the lattice", "ask for 1 node or more, or for a spacing above zero");
    const Bounds box = bounds(mesh);
    const double volume = std::abs(palpate::volume(mesh));
    if (!(volume > 0))
        throw Error("a surface that encloses no volume", "the lattice", "close it, or use a cloth");

    float spacing = settings.spacing > 0 ? settings.spacing : float(std::cbrt(volume / settings.nodes));
    frame_around(box, spacing);  // refuses what would be too large before anything is built
    const SignedDistance distance(mesh, spacing / samples);
    auto fill_at = [&](float h) {
        Sampled sampled(frame_around(box, h), h);
        mark_inside(distance, sampled);
        mark_surface(mesh, sampled);
        Cells cells = fill(sampled.frame.dims, sampled.cells);
        find_parts(cells, sampled.cells);
        return std::pair(sampled.frame, std::move(cells));
    };
    auto assemble_at = [&](float h) {
        const auto [frame, cells] = fill_at(h);
        Body body = assemble(corners_of(cells), cells, frame.origin, h, isotropic_links(settings.material, h),
                             settings.material, equal_links(settings.material), volume);
        const std::vector<float> depth = distance.sample(frame.origin, h, frame.dims + 1);
        for (std::size_t i = 0; i < body.count(); ++i) {
            const ivec3 p = body.at[i];
            body.cover[i] = -depth[(std::size_t(p.z) * (frame.dims.y + 1) + p.y) * (frame.dims.x + 1) + p.x];
        }
        return body;
    };
    if (settings.spacing > 0) return assemble_at(spacing);

    // The number of nodes falls with the cube of the spacing, roughly and in jumps: follow the cube root
    // until it is met within half a percent, and keep the best of a dozen tries.
    float best = spacing;
    double best_miss = 1e30;
    for (int attempt = 0; attempt < 12 && best_miss > 0.005; ++attempt) {
        const double ratio = double(count(corners_of(fill_at(spacing).second))) / settings.nodes;
        if (const double miss = std::abs(std::log(ratio)); miss < best_miss) {
            best_miss = miss;
            best = spacing;
        }
        if (progress) progress("fitting the lattice", (attempt + 1) / 12.0);
        spacing *= float(std::cbrt(std::clamp(ratio, 0.05, 20.0)));
    }
    return assemble_at(best);
}

bool restuff(Body& body, const Material& from, const Material& to, double volume) {
    check_stiffness(to);
    check_mass(to);
    if (equal_links(from) != equal_links(to) || (tissue_of(body) != nullptr) != is_tissue(to)) return false;
    GridSprings& springs = *body.grid();
    springs.links = isotropic_links(to, body.spacing);
    springs.strength.clear();
    for (Term& term : body.terms)
        if (auto* cells = std::get_if<TissueCells>(&term))
            *cells = {to.youngs_modulus, to.poisson, cells->filled, cells->filled};
    body.damping = to.damping;
    body.link_damping = to.link_damping;
    weigh(body, to, equal_links(to), std::abs(volume));
    return true;
}

namespace {

Body plain_box(ivec3 dims, float spacing, std::vector<Link> links, const Material& material, bool equal) {
    const dvec3 size(dims);
    if (std::min({dims.x, dims.y, dims.z}) < 1 || size.x * size.y * size.z > most_cells)
        throw Error(fmt::format("{} x {} x {} nodes", dims.x, dims.y, dims.z), "the lattice",
                    "use fewer than 30 million, and 1 or more along each axis");
    if (!(spacing > 0 && std::isfinite(spacing)))
        throw Error(fmt::format("a spacing of {} m", spacing), "the lattice", "use one above zero");
    Cells cells{glm::max(dims - 1, ivec3(0)), {}};
    cells.filled.assign(std::size_t(cells.dims.x) * cells.dims.y * cells.dims.z, 1);
    GridIndex grid(ivec3(0), dims);
    std::fill(grid.numbers.begin(), grid.numbers.end(), 0);
    return assemble(std::move(grid), cells, vec3(0), spacing, std::move(links), material, equal, 0);
}

}  // namespace

Body lattice(ivec3 dims, float spacing, const Material& material) {
    if (!is_bare(material)) {
        check_stiffness(material);
        check_mass(material);
    }
    Material of_what = material;
    if (std::min({dims.x, dims.y, dims.z}) < 2 && material.model == MaterialModel::automatic)
        of_what.model = MaterialModel::springs;
    return plain_box(dims, spacing, isotropic_links(of_what, spacing), of_what, equal_links(of_what));
}

Body lattice(ivec3 dims, float spacing, const SpringKinds& stiffness, const Material& material) {
    check_mass(material);
    Material of_springs = material;
    of_springs.model = MaterialModel::springs;
    return plain_box(dims, spacing, links_of_kinds(stiffness, spacing), of_springs, true);
}

}  // namespace palpate
