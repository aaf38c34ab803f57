#pragma once
#include "palpate/body/influences.h"

#include <span>
#include <vector>

namespace palpate {

/// A vertex of a surface that a tip presses.
struct PressedVertex {
    std::size_t vertex = 0;
    double pressure = 0;     // Pa
    double area = 0;         // m², a third of the triangles around it
    dvec3 force = dvec3(0);  // N: this pressure on this area
};

/// How the force of a tip spreads over a surface. `positions`: where its vertices are now. Each vertex is
/// pressed away from the tip's centre in proportion to its depth in the tip, with a factor by which the
/// components along `force`, N, add up to that. The factor is not quite that of the law (Press), since nodes
/// stand for other areas than vertices: docs/touch.md has figures. Empty where the tip reaches no vertex, as
/// between those of a coarse surface. Throws Error if the press, the force or a position is not finite, or a
/// triangle names no vertex.
std::vector<PressedVertex> pressed_vertices(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                            const Press& press, dvec3 force);

/// A tactile sensor: a rectangle of taxels, each of which measures the mean pressure over its part.
struct Pad {
    vec3 centre = vec3(0);                   // m
    vec3 width = vec3(0), height = vec3(0);  // m, from side to side: along the columns, along the rows
    int columns = 4, rows = 4;

    bool operator==(const Pad&) const = default;
};

/// The mean pressure in each taxel, Pa, row by row from the corner centre - width / 2 - height / 2: what
/// presses on it along the pad's normal, by its area. Each vertex gives its force to the square of its area
/// around it. So the pressures times the taxels' area add up to the force along the normal, if the pad covers
/// the contact. Either side of it may face the body. Throws Error if the pad is not a parallelogram of finite
/// sides, or does not have 1 to 10,000 taxels, or if a vertex is not of this surface.
std::vector<double> taxels(const Pad& pad, std::span<const vec3> positions,
                           std::span<const PressedVertex> pressed);

}  // namespace palpate
