#pragma once
#include "palpate/run/tip.h"
#include "palpate/scene/camera.h"

#include <optional>
#include <span>

namespace palpate {

/// A ray into a picture.
struct Ray {
    vec3 from = vec3(0);          // m
    vec3 along = vec3(0, 0, -1);  // unit

    vec3 at(float way) const { return from + way * along; }
};

/// The view direction of a camera, unit.
vec3 forward_of(const Camera& camera);

/// The view ray through a place in the picture, in pixels to the right and down from its upper left corner.
Ray ray_through(const Camera& camera, vec2 pixel, ivec2 size);

/// Projects a point of the scene into the picture, in pixels; nothing if it is behind the eye.
std::optional<vec2> pixel_of(const Camera& camera, vec3 point, ivec2 size);

/// A view with a pointer in it: a camera, the size of the picture, and a pixel.
struct Sight {
    Camera camera;
    ivec2 size = ivec2(1);  // of the picture, pixels
    vec2 pixel = vec2(0);   // that is pointed at

    Ray ray() const { return ray_through(camera, pixel, size); }
    /// The depth of a place before the eye, along the view, m; and the place of that depth under the pointer.
    float depth_of(vec3 place) const { return glm::dot(place - camera.eye, forward_of(camera)); }
    vec3 at_depth(float depth) const { return ray().at(depth / glm::dot(ray().along, forward_of(camera))); }
};

/// The first intersection of a ray with surfaces.
struct Hit {
    float way = 0;            // m, along the ray
    std::size_t surface = 0;  // its number
    uvec3 corners = {};       // the triangle's
    vec3 place = vec3(0);     // m
    vec3 normal = vec3(0);    // unit, the face normal towards the eye
};
std::optional<Hit> pick(const Ray& ray, std::span<const Skin> skins);

/// The bounding box of all skins.
Bounds bounds_of(std::span<const Skin> skins);

/// An orbit camera (arcball), moved by a pointer. Angles and shifts are in pixels of a picture of the given
/// height, so that it feels the same in every window.
class Orbit {
 public:
    explicit Orbit(const Camera& home = {}) : home_(home), camera_(home) {}

    const Camera& camera() const { return camera_; }

    /// Rotates about the point that it looks at. Up stays up: it stops short of the poles.
    void turn(vec2 pixels, int height);
    /// Moves sideways, so that the point that it looks at follows the pointer.
    void pan(vec2 pixels, int height);
    /// Moves nearer by notches of a wheel, or farther if negative.
    void zoom(float notches);
    /// Moves so that the whole box is in view, from the same direction.
    void frame(const Bounds& box);
    /// Returns to the scene's camera.
    void reset() { camera_ = home_; }

 private:
    Camera home_, camera_;
};

}  // namespace palpate
