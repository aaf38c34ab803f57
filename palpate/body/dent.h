#pragma once
#include "palpate/base/vectors.h"

#include <span>

namespace palpate {

/// A Gaussian dent in a surface (Luciano, Banerjee and Rizzi 2007, section IV): each place on it moves by
/// depth · exp(-d² / 2 width²), where d is its distance from `centre`. Several dents add up. Distances are
/// measured on the surface as it lies now but without dents, where the contact point of the Proxy is, too.
/// They are Euclidean, not along the surface, so a near but unconnected part is dented as well, as the paper
/// says. In the paper each place moves against its own normal, so folds and thin parts intersect themselves;
/// with `facing` all places move in one direction, and none do.
struct Dent {
    vec3 centre = vec3(0);  // m
    float depth = 0;        // m; below 0 it is a bump
    float width = 0.01f;    // m, the standard deviation
    vec3 facing = vec3(0);  // unit, out of the surface: all places move against it; zero: each against its
                            // own normal
};

/// The most dents of a surface in a picture.
constexpr int most_dents = 64;

/// Whether it moves anything. It does not if its depth is 0 or if one of its numbers is unusable: not finite,
/// beyond 1e9 m, or a width under 1e-9 m.
bool acts(const Dent& dent);

/// How far all dents together move a place of the undented surface against its normal (unit), m.
float depth_at(std::span<const Dent> dents, vec3 place, vec3 normal);

/// The dented place; `normal` is that of the undented surface, unit.
vec3 dented(std::span<const Dent> dents, vec3 place, vec3 normal);

/// The normal of the dented surface there, unit. Exact with `facing`, and on a plane. Otherwise, on a surface
/// with radius of curvature R, its turn is wrong by about the factor depth / R (docs/results.md has the
/// table).
vec3 dented_normal(std::span<const Dent> dents, vec3 place, vec3 normal);

/// The most depth of overlapping dents of that width, m: 1.2 times the width, which slopes a plane by 36°. Up
/// to 1.65 widths (√e), a dent with `facing` is a one-to-one map of space, so no surface can fold over.
double deepest_dent(double width);

/// A bound on how far all dents together move any place, m.
float largest_displacement(std::span<const Dent> dents);

}  // namespace palpate
