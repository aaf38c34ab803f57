#pragma once
#include "palpate/base/vectors.h"

#include <array>
#include <variant>
#include <vector>

namespace palpate {

struct Mesh;

/// A half-space: keeps nodes on the side to which its normal points, dot(normal, p) >= offset.
struct Plane {
    vec3 normal = vec3(0, 1, 0);  // unit
    float offset = 0;             // m
};

/// Keeps nodes out of a ball.
struct Sphere {
    vec3 centre = vec3(0);  // m
    float radius = 0.1f;    // m
};

/// Keeps nodes out of a capsule, a rod with round ends.
struct Capsule {
    vec3 from = vec3(0), to = vec3(0, 0.1f, 0);  // m, the centre of each end
    float radius = 0.02f;                        // m
};

/// Keeps nodes out of an oriented box, whose edges may be rounded.
struct Box {
    vec3 centre = vec3(0);        // m
    vec3 half = vec3(0.1f);       // m, half its sides without the rounding
    std::array<vec3, 3> axes = {  // unit and at right angles: along its sides
        vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    float rounding = 0;  // m, by which it is larger on every side
};

/// Triangles that nodes do not pass from either side (2012, section 4: an arbitrary polygon). A node keeps
/// the distance `thickness` on the side from which it comes, however fast it is: continuous collision
/// detection.
struct Polygon {
    std::vector<std::array<vec3, 3>> triangles;  // m
    float thickness = 0.001f;                    // m
};

/// Keeps nodes out of a closed mesh: a signed distance field (SDF), sampled on a grid.
struct DistanceField {
    vec3 origin = vec3(0);        // m, the first point
    float spacing = 0;            // m
    ivec3 dims = ivec3(0);        // points along each axis, at least 2
    std::vector<float> distance;  // m, negative inside; x runs fastest

    /// The signed distance, by trilinear interpolation; outside the grid, that of the nearest point of its
    /// rim.
    float at(vec3 p) const;
    /// Its gradient by central differences over one spacing, not scaled.
    vec3 gradient(vec3 p) const;
};

/// The signed distance field of a closed mesh; it extends three cells beyond the mesh. Throws Error like
/// SignedDistance.
DistanceField distance_field(const Mesh& mesh, float spacing);

/// A rigid obstacle (2012, section 4). A node inside it is projected to the nearest point of the surface,
/// loses its inward velocity, and slides on with Coulomb friction (at most `friction` times the impulse along
/// the normal).
struct Collider {
    std::variant<Plane, Sphere, Capsule, Box, Polygon, DistanceField> shape;
    float friction = 0;  // wet tissue on steel 0.1, cloth on wood 0.4
    float margin = 0;    // m: the distance that nodes keep, because the surface drawn between them sinks in
};

/// The rigid motion of a collider relative to its shape: a point p of the shape is at position + rotation ·
/// p.
struct Motion {
    vec3 position = vec3(0);  // m
    mat3 rotation = mat3(1);
    vec3 velocity = vec3(0);  // m/s, of the point at `position`
    vec3 spin = vec3(0);      // rad/s, the angular velocity about that point
};

/// The motion after some seconds with its velocity and spin.
Motion after(const Motion& motion, float seconds);

}  // namespace palpate
