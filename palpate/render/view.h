#pragma once
#include "palpate/base/vectors.h"
#include "palpate/render/picture.h"

#include <span>

namespace palpate {

/// A ball around the things in a picture.
struct Extent {
    vec3 centre = vec3(0);  // m
    float radius = 1;       // m
};

/// The box around all points. Those that are not finite, or farther off than any sane thing, do not count.
Bounds bounds_of(std::span<const vec3> points);
Bounds bounds_of(const Ball& ball);

/// The ball around a box; of 1 m around the origin if that is empty.
Extent around(const Bounds& box);

/// Around all that a picture shows but its grounds; if that is nothing, around where its camera looks.
/// `surfaces`: the box around each of the picture's.
Extent extent(const Picture& picture, std::span<const Bounds> surfaces);

/// How a camera sees: always finite, however odd the camera.
struct View {
    mat4 to_clip;  // from the world to OpenGL's clip space
    vec4 eye;      // (the eye, 1), or (the direction towards the eye, 0) where all sight lines are parallel
    vec3 up;       // where the sky is; unit
};

/// `v` made unit, or `otherwise` where it has no direction: zero or not finite.
vec3 unit(vec3 v, vec3 otherwise);

/// The axes right, up and backward of something that looks along `forward` (unit).
mat3 axes(vec3 forward, vec3 up);

/// The view of a camera whose pictures are `aspect` times as wide as high. The near and far planes enclose
/// `things`.
View view(const Camera& camera, float aspect, const Extent& things);

/// From the world to the clip space of parallel light that travels along `direction` (unit), which `things`
/// fill.
mat4 along(vec3 direction, const Extent& things);

/// The same, but to a texture's space: 0 to 1 in each direction.
mat4 to_texture(const mat4& to_clip);

}  // namespace palpate
