#pragma once
#include "palpate/run/tip.h"
#include "palpate/scene/camera.h"

#include <optional>
#include <span>

namespace palpate {

/// A straight line of sight into a picture.
struct Ray {
    vec3 from = vec3(0);          // m
    vec3 along = vec3(0, 0, -1);  // unit

    vec3 at(float way) const { return from + way * along; }
};

/// In which a camera looks, unit.
vec3 forward_of(const Camera& camera);

/// Through a place in the picture, in pixels to the right and down from its upper left corner.
Ray ray_through(const Camera& camera, vec2 pixel, ivec2 size);

/// Where a point of the scene is in the picture, in pixels; nothing if it is behind the eye.
std::optional<vec2> pixel_of(const Camera& camera, vec3 point, ivec2 size);

/// What somebody looks at who points into a picture.
struct Sight {
    Camera camera;
    ivec2 size = ivec2(1);  // of the picture, pixels
    vec2 pixel = vec2(0);   // that is pointed at

    Ray ray() const { return ray_through(camera, pixel, size); }
    /// How far something lies before the eye, along the view, m; and what lies so far under the pointer.
    float depth_of(vec3 place) const { return glm::dot(place - camera.eye, forward_of(camera)); }
    vec3 at_depth(float depth) const { return ray().at(depth / glm::dot(ray().along, forward_of(camera))); }
};

/// What a ray meets first of some surfaces.
struct Hit {
    float way = 0;            // m, along the ray
    std::size_t surface = 0;  // its number
    uvec3 corners = {};       // the triangle's
    vec3 place = vec3(0);     // m
    vec3 normal = vec3(0);    // unit, of the triangle, towards the eye
};
std::optional<Hit> pick(const Ray& ray, std::span<const Skin> skins);

/// Around all skins.
Bounds bounds_of(std::span<const Skin> skins);

/// A camera that a pointer moves. Angles and shifts come in pixels of a picture that is so many pixels high,
/// so that it feels the same in every window.
class Orbit {
 public:
    explicit Orbit(const Camera& home = {}) : home_(home), camera_(home) {}

    const Camera& camera() const { return camera_; }

    /// About what it looks at, which stays in the middle. The sky stays above: it stops short of the poles.
    void turn(vec2 pixels, int height);
    /// Along with what it looks at, which goes with the pointer.
    void pan(vec2 pixels, int height);
    /// Nearer by so many notches of a wheel, or farther where that is negative.
    void zoom(float notches);
    /// So that all of a box can be seen, from the same side.
    void frame(const Bounds& box);
    /// As the scene says.
    void reset() { camera_ = home_; }

 private:
    Camera home_, camera_;
};

}  // namespace palpate
