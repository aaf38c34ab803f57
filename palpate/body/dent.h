#pragma once
#include "palpate/base/vectors.h"

#include <span>

namespace palpate {

/// A dent in a surface (Luciano, Banerjee and Rizzi 2007, section IV): each place on it moves by
/// depth · exp(-d² / 2 width²), d being its distance from `centre`. Several add up. Distances are taken on
/// the surface without any dents, wherever it is at the moment; that is where the contact point (Proxy) is
/// too. They are straight, so that a near but unconnected part of the surface is dented as well, as the paper
/// says of itself. In the paper each place moves against its own normal, so that folds and thin parts come
/// through themselves; where `facing` is set, all of it moves one way, and nothing does.
struct Dent {
    vec3 centre = vec3(0);  // m
    float depth = 0;        // m; below 0 it is a bump
    float width = 0.01f;    // m, the standard deviation
    vec3 facing = vec3(0);  // unit, out of the surface: all moves against it; zero: against its own normal
};

/// How many of them a surface can have in a picture.
constexpr int most_dents = 64;

/// Whether it moves anything. It does not if its depth is 0, or if any of it is no sane length: not finite,
/// beyond 1e9 m, or a width under 1e-9 m.
bool acts(const Dent& dent);

/// How far all of them move a place of the undented surface against its own normal there (unit), m.
float depth_at(std::span<const Dent> dents, vec3 place, vec3 normal);

/// Where that place is then; `normal` is the surface's own, unit.
vec3 dented(std::span<const Dent> dents, vec3 place, vec3 normal);

/// The dented surface's normal there, unit. Exact where dents face a way, and on a plane; elsewhere, where
/// the surface is curved with a radius R, off by about depth / R of the turn (docs/results.md has the table).
vec3 dented_normal(std::span<const Dent> dents, vec3 place, vec3 normal);

/// How deep dents of that width may be all together, m: 1.2 times their width. A plane slopes by 36° in them
/// then. Up to 1.65 widths (√e) no two places of space come together where all of it moves one way
/// (`facing`): so whatever a surface is like, it can bear that.
double deepest_dent(double width);

/// How far they move any place at most, m.
float furthest(std::span<const Dent> dents);

}  // namespace palpate
