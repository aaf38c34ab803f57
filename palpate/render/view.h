#pragma once
#include "palpate/base/vectors.h"
#include "palpate/render/picture.h"

#include <span>

namespace palpate {

/// A bounding sphere of the things in a picture.
struct Extent {
    vec3 centre = vec3(0);  // m
    float radius = 1;       // m
};

/// The bounding box of points. It ignores points that are not finite or absurdly far away.
Bounds bounds_of(std::span<const vec3> points);
Bounds bounds_of(const Ball& ball);

/// The bounding sphere of a box; of radius 1 m around the origin if the box is empty.
Extent around(const Bounds& box);

/// The bounding sphere of everything in a picture but its grounds; if that is nothing, around the point at
/// which its camera looks. `surfaces`: the bounding box of each of the picture's.
Extent extent(const Picture& picture, std::span<const Bounds> surfaces);

/// The transforms of a camera: always finite, however odd the camera.
struct View {
    mat4 to_clip;  // from the world to OpenGL's clip space
    vec4 eye;      // in homogeneous coordinates: (the eye, 1), or (the direction towards the eye, 0) in a
                   // parallel projection
    vec3 up;       // towards the sky; unit
};

/// `v` made unit, or `otherwise` where it has no direction: zero or not finite.
vec3 unit(vec3 v, vec3 otherwise);

/// The axes right, up and backward of a camera that looks along `forward` (unit).
mat3 axes(vec3 forward, vec3 up);

/// The view of a camera whose pictures have that `aspect` ratio, width over height. The near and far planes
/// enclose `things`.
View view(const Camera& camera, float aspect, const Extent& things);

/// From the world to the clip space of parallel light along `direction` (unit), fitted to `things`: an
/// orthographic projection.
mat4 light_projection(vec3 direction, const Extent& things);

/// The same, but to texture space: 0 to 1 in each direction.
mat4 to_texture(const mat4& to_clip);

}  // namespace palpate
