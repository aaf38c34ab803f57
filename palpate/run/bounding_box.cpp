#include "palpate/run/bounding_box.h"

#include "palpate/scene/camera.h"

#include <span>

namespace palpate {
namespace {

Box box_around(const Bounds& bounds) { return {.centre = bounds.centre(), .half = 0.5f * bounds.size()}; }

std::optional<Box> box_around(const Plane&) { return std::nullopt; }
std::optional<Box> box_around(const Box& box) { return box; }
std::optional<Box> box_around(const Sphere& sphere) {
    return Box{.centre = sphere.centre, .half = vec3(0), .rounding = sphere.radius};
}
std::optional<Box> box_around(const Capsule& capsule) {
    const vec3 rod = capsule.to - capsule.from;
    const float length = glm::length(rod);
    Box box{.centre = 0.5f * (capsule.from + capsule.to),
            .half = vec3(0, 0.5f * length, 0),
            .rounding = capsule.radius};
    if (const mat3 axes = upright(rod); length > 0) box.axes = {axes[0], axes[1], axes[2]};
    return box;
}
std::optional<Box> box_around(const Polygon& polygon) {
    Bounds box;
    for (const auto& corners : polygon.triangles)
        for (vec3 p : corners) box.include(p);
    return box.empty() ? std::nullopt : std::optional(box_around(box));
}
// The field extends three cells beyond its mesh.
std::optional<Box> box_around(const DistanceField& field) {
    const vec3 first = field.origin + 3 * field.spacing;
    return box_around(Bounds{first, first + field.spacing * vec3(field.dims - 7)});
}

}  // namespace

std::optional<Box> bounding_box(const Collider& collider) {
    return std::visit([](const auto& shape) { return std::optional<Box>(box_around(shape)); },
                      collider.shape);
}

}  // namespace palpate
