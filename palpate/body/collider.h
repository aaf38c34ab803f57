#pragma once
#include "palpate/base/vectors.h"

#include <array>
#include <variant>
#include <vector>

namespace palpate {

struct Mesh;

/// Keeps nodes on the side its normal points to: dot(normal, p) >= offset.
struct Plane {
    vec3 normal = vec3(0, 1, 0);  // unit
    float offset = 0;             // m
};

/// Keeps nodes out of a ball.
struct Sphere {
    vec3 centre = vec3(0);  // m
    float radius = 0.1f;    // m
};

/// Keeps nodes out of a rod with round ends.
struct Capsule {
    vec3 from = vec3(0), to = vec3(0, 0.1f, 0);  // m, the middle of each end
    float radius = 0.02f;                        // m
};

/// Keeps nodes out of a box, whose edges may be rounded off.
struct Box {
    vec3 centre = vec3(0);        // m
    vec3 half = vec3(0.1f);       // m, half its sides without the rounding
    std::array<vec3, 3> axes = {  // unit and at right angles: along its sides
        vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    float rounding = 0;  // m, that it reaches further out on every side
};

/// Open triangles that nodes do not pass through from either side (2012, section 4: an arbitrary polygon). A
/// node stays `thickness` off the side it comes from, however fast it comes.
struct Polygon {
    std::vector<std::array<vec3, 3>> triangles;  // m
    float thickness = 0.001f;                    // m
};

/// Keeps nodes out of a closed mesh, by the signed distance at the points of a grid.
struct DistanceField {
    vec3 origin = vec3(0);        // m, the first point
    float spacing = 0;            // m
    ivec3 dims = ivec3(0);        // points along each axis, at least 2
    std::vector<float> distance;  // m, negative inside; x runs fastest

    /// By trilinear interpolation; outside the grid as far as at its rim.
    float at(vec3 p) const;
    /// Which way it grows: its differences across one spacing.
    vec3 uphill(vec3 p) const;
};

/// The field of a closed mesh; it reaches three cells beyond it. Throws Error as SignedDistance does.
DistanceField distance_field(const Mesh& mesh, float spacing);

/// Something hard that nodes do not enter (2012, section 4): a node inside is moved to the nearest point of
/// the surface, loses its inward velocity, and slides on against dry friction (Coulomb: at most `friction`
/// times the push along the normal).
struct Collider {
    std::variant<Plane, Sphere, Capsule, Box, Polygon, DistanceField> shape;
    float friction = 0;  // wet tissue on steel 0.1, cloth on wood 0.4
    float margin = 0;    // m: nodes stay so far off, because what is drawn between them sinks in
};

/// Where a collider is and how it moves, against where its shape was given: a point p of the shape is at
/// position + rotation · p.
struct Motion {
    vec3 position = vec3(0);  // m
    mat3 rotation = mat3(1);
    vec3 velocity = vec3(0);  // m/s, of the point that `position` names
    vec3 spin = vec3(0);      // rad/s, about it
};

/// The same motion after some seconds of its velocity and spin.
Motion after(const Motion& motion, float seconds);

}  // namespace palpate
