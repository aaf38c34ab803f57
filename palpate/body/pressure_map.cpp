#include "palpate/body/pressure_map.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// A third of the triangles around each.
void find_areas(std::span<PressedVertex> vertices, std::span<const vec3> positions,
                std::span<const uvec3> triangles) {
    std::vector<PressedVertex*> at(positions.size(), nullptr);
    for (PressedVertex& one : vertices) at[one.vertex] = &one;
    for (uvec3 t : triangles) {
        if (std::max({t.x, t.y, t.z}) >= positions.size())
            throw Error("a triangle of a vertex that there is not", "a pressure map",
                        "count vertices from 0");
        if (!at[t.x] && !at[t.y] && !at[t.z]) continue;
        const dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
        const double third = glm::length(glm::cross(b - a, c - a)) / 6;
        for (unsigned corner : {t.x, t.y, t.z})
            if (at[corner]) at[corner]->area += third;
    }
}

void check(const Pad& pad) {
    auto require = [](bool holds, const char* what, const char* remedy) {
        if (!holds) throw Error(what, "a pad", remedy);
    };
    const double area = glm::length(glm::cross(dvec3(pad.width), dvec3(pad.height)));
    require(area > 0 && std::isfinite(area) && std::isfinite(glm::length(pad.centre)),
            "sides that are parallel, zero or not finite", "give it a width and a height in m");
    require(pad.columns > 0 && pad.rows > 0 && double(pad.columns) * pad.rows <= 10'000,
            "no taxels, or more than 10,000", "give it as many columns and rows as the sensor has");
}

// How what lies evenly on a stretch along a side of a pad falls on its columns, or rows.
struct Spread {
    double begin, end;  // counted in columns
    int first, last;    // those that it reaches

    // `middle`: from the middle of the side; like `length` a part of it.
    Spread(double middle, double length, int count)
        : begin((0.5 + middle - length / 2) * count), end(begin + length * count) {
        first = int(std::floor(std::clamp(begin, 0.0, double(count))));
        last = int(std::ceil(std::clamp(end, 0.0, double(count)))) - 1;
    }
    double share(int column) const {
        return (std::min(end, column + 1.0) - std::max(begin, double(column))) / (end - begin);
    }
};

}  // namespace

std::vector<PressedVertex> pressed_vertices(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                            const Press& press, dvec3 force) {
    const double strength = glm::length(force), steepness = pressure_per_metre(press);
    const dvec3 centre(press.centre);
    std::vector<PressedVertex> all;
    double sum = 0;  // that is finite only if all of it is
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const dvec3 away = dvec3(positions[v]) - centre;
        const double distance = glm::length(away), depth = double(press.radius) - distance;
        sum += distance;
        if (depth > 0 && distance > 0) all.push_back({v, steepness * depth, 0, away / distance});
    }
    if (!std::isfinite(sum + strength + steepness) || !(press.radius > 0))
        throw Error("a press, a force or a vertex that is not finite", "a pressure map",
                    "hand in places in m and a force in N");
    find_areas(all, positions, triangles);
    double along = 0;  // N
    for (PressedVertex& one : all) {
        one.force *= one.pressure * one.area;
        if (strength > 0) along += glm::dot(one.force, force / strength);
    }
    if (!(along > 0)) return {};
    for (PressedVertex& one : all) {
        one.pressure *= strength / along;
        one.force *= strength / along;
    }
    return all;
}

std::vector<double> taxels(const Pad& pad, std::span<const vec3> positions,
                           std::span<const PressedVertex> pressed) {
    check(pad);
    const dvec3 width(pad.width), height(pad.height), across = glm::cross(width, height);
    const double area = glm::length(across);
    dvec3 force(0);
    for (const PressedVertex& one : pressed) force += one.force;
    const dvec3 normal = (glm::dot(force, across) < 0 ? -1 : 1) / area * across;
    std::vector<double> pressures(std::size_t(pad.columns) * std::size_t(pad.rows), 0);
    for (const PressedVertex& one : pressed) {
        if (one.vertex >= positions.size())
            throw Error(fmt::format("vertex {} of {}", one.vertex, positions.size()), "the taxels of a pad",
                        "hand in the surface that was pressed");
        if (!(one.area > 0)) continue;
        const dvec3 from = dvec3(positions[one.vertex]) - dvec3(pad.centre);
        const double side = std::sqrt(one.area);
        const Spread columns(glm::dot(glm::cross(from, height), across) / (area * area),
                             side / glm::length(width), pad.columns),
            rows(glm::dot(glm::cross(width, from), across) / (area * area), side / glm::length(height),
                 pad.rows);
        const double pressure = glm::dot(one.force, normal) * double(pressures.size()) / area;
        for (int r = rows.first; r <= rows.last; ++r)
            for (int c = columns.first; c <= columns.last; ++c)
                pressures[std::size_t(r * pad.columns + c)] += rows.share(r) * columns.share(c) * pressure;
    }
    return pressures;
}

}  // namespace palpate
