#include "palpate/files/formats/solids.h"

#include "palpate/files/formats/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace palpate {
namespace {

constexpr Index around = 32, above = 16;

void add_face(Draft& draft, std::initializer_list<Index> corners) {
    draft.corners.insert(draft.corners.end(), corners);
    draft.sizes.push_back(Index(corners.size()));
}

dvec3 on_circle(double radius, double y, Index k) {
    const double angle = 2 * std::numbers::pi * k / around;
    return {radius * std::sin(angle), y, radius * std::cos(angle)};
}

// Adds points around y; returns the index of the first.
Index add_ring(Draft& draft, double radius, double y) {
    const Index first = Index(draft.positions.size());
    for (Index k = 0; k < around; ++k) draft.positions.push_back(on_circle(radius, y, k));
    return first;
}

Index add_point(Draft& draft, dvec3 point) {
    draft.positions.push_back(point);
    return Index(draft.positions.size() - 1);
}

Index next(Index k) { return (k + 1) % around; }

void add_band(Draft& draft, Index below, Index over) {
    for (Index k = 0; k < around; ++k)
        add_face(draft, {below + k, below + next(k), over + next(k), over + k});
}

// A fan from a point to a ring below or above it.
void add_cap(Draft& draft, Index ring, Index point, bool over) {
    for (Index k = 0; k < around; ++k)
        add_face(draft, {ring + (over ? k : next(k)), ring + (over ? next(k) : k), point});
}

void add_lid(Draft& draft, Index ring, bool over) {
    for (Index k = 0; k < around; ++k) draft.corners.push_back(ring + (over ? k : around - 1 - k));
    draft.sizes.push_back(around);
}

dvec3 unit_or_zero(dvec3 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3(0);
}

// The shortest rotation from y to a direction.
dmat3 from_y_to(dvec3 direction) {
    const dvec3 axis = glm::cross(dvec3(0, 1, 0), direction);
    const double sine = glm::length(axis), cosine = direction.y;
    return rotation_about(sine > 0 ? axis : dvec3(1, 0, 0), std::atan2(sine, cosine));
}

// The frame of the cross section at each point of a spine: y along the spine, z perpendicular to its bend.
// Where it is straight, z is kept; if it is straight everywhere, all frames rotate with y.
std::vector<dmat3> frames_along(std::span<const dvec3> spine, bool closed) {
    const std::size_t n = spine.size();
    std::vector<dvec3> along(n), out(n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool inner = i > 0 && i + 1 < n;
        const std::size_t before = inner || !closed ? (i > 0 ? i - 1 : 0) : n - 2,
                          after = inner || !closed ? (i + 1 < n ? i + 1 : n - 1) : 1;
        along[i] = unit_or_zero(spine[after] - spine[before]);
        if (inner || closed)
            out[i] = unit_or_zero(glm::cross(spine[after] - spine[i], spine[before] - spine[i]));
    }
    const auto bend = std::ranges::find_if(out, [](dvec3 z) { return glm::length(z) > 0; });
    if (bend == out.end()) return std::vector<dmat3>(n, from_y_to(unit_or_zero(spine[n - 1] - spine[0])));
    std::vector<dmat3> frames;
    dvec3 z = *bend;
    for (std::size_t i = 0; i < n; ++i) {
        if (glm::length(out[i]) > 0) z = glm::dot(out[i], z) < 0 ? -out[i] : out[i];
        const dvec3 x = unit_or_zero(glm::cross(along[i], z));
        frames.emplace_back(x, along[i], unit_or_zero(glm::cross(x, along[i])));
    }
    return frames;
}

// Entry i of a list, or its last entry.
template <class T>
T value_at(const std::vector<T>& list, std::size_t i, T fallback) {
    return list.empty() ? fallback : list[std::min(i, list.size() - 1)];
}

}  // namespace

void add_box(Draft& draft, dvec3 size) {
    const Index a = Index(draft.positions.size());
    for (int i = 0; i < 8; ++i)
        draft.positions.push_back(0.5 * size * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    for (auto [p, q, r, s] : {std::array<Index, 4>{0, 2, 3, 1},
                              {4, 5, 7, 6},
                              {0, 1, 5, 4},
                              {2, 6, 7, 3},
                              {0, 4, 6, 2},
                              {1, 3, 7, 5}})
        add_face(draft, {a + p, a + q, a + r, a + s});
}

void add_sphere(Draft& draft, double radius) {
    const Index low = add_point(draft, {0, -radius, 0}), high = add_point(draft, {0, radius, 0});
    Index below = 0;
    for (Index row = 1; row < above; ++row) {
        const double angle = std::numbers::pi * (double(row) / above - 0.5);
        const Index ring = add_ring(draft, radius * std::cos(angle), radius * std::sin(angle));
        if (row == 1)
            add_cap(draft, ring, low, false);
        else
            add_band(draft, below, ring);
        below = ring;
    }
    add_cap(draft, below, high, true);
}

void add_turned(Draft& draft, const Turned& shape) {
    const double half = 0.5 * shape.height;
    const Index bottom = add_ring(draft, shape.bottom_radius, -half);
    if (shape.bottom) add_lid(draft, bottom, false);
    if (shape.top_radius == 0) {
        if (shape.side) add_cap(draft, bottom, add_point(draft, {0, half, 0}), true);
        return;
    }
    const Index top = add_ring(draft, shape.top_radius, half);
    if (shape.side) add_band(draft, bottom, top);
    if (shape.top) add_lid(draft, top, true);
}

void add_extrusion(Draft& draft, const Extruded& shape) {
    if (shape.spine.size() < 2 || shape.section.size() < 2) return;
    const bool ring = shape.section.front() == shape.section.back(),
               loop = shape.spine.front() == shape.spine.back();
    const Index corners = Index(shape.section.size() - ring), rings = Index(shape.spine.size() - loop),
                first = Index(draft.positions.size());
    const std::vector<dmat3> frames = frames_along(shape.spine, loop);
    for (Index j = 0; j < rings; ++j) {
        const dvec2 scale = value_at(shape.scales, j, dvec2(1));
        const dmat3 turn = frames[j] * value_at(shape.turns, j, dmat3(1));
        for (Index k = 0; k < corners; ++k) {
            const dvec2 p = scale * shape.section[k];
            draft.positions.push_back(shape.spine[j] + turn * dvec3(p.x, 0, p.y));
        }
    }
    const Index steps = Index(shape.spine.size()) - 1, sides = Index(shape.section.size()) - 1;
    for (Index j = 0; j < steps; ++j)
        for (Index k = 0; k < sides; ++k) {
            const Index a = first + j * corners, d = first + (j + 1) % rings * corners, b = (k + 1) % corners;
            add_face(draft, {a + k, a + b, d + b, d + k});
        }
    const auto cap = [&](Index start, bool reversed) {
        for (Index k = 0; k < corners; ++k) draft.corners.push_back(start + (reversed ? corners - 1 - k : k));
        draft.sizes.push_back(corners);
    };
    if (shape.begin_cap && !loop) cap(first, true);
    if (shape.end_cap && !loop) cap(first + (rings - 1) * corners, false);
}

void add_elevation_grid(Draft& draft, std::span<const double> heights, std::size_t columns, double x_spacing,
                        double z_spacing) {
    const Index first = Index(draft.positions.size()), width = Index(columns);
    const std::size_t rows = columns == 0 ? 0 : heights.size() / columns;
    for (std::size_t i = 0; i < rows * columns; ++i)
        draft.positions.push_back(
            {x_spacing * double(i % columns), heights[i], z_spacing * double(i / columns)});
    for (Index z = 0; z + 1 < rows; ++z)
        for (Index x = 0; x + 1 < width; ++x) {
            const Index a = first + z * width + x;
            add_face(draft, {a, a + width, a + width + 1, a + 1});
        }
}

}  // namespace palpate
