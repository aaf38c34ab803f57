#include "palpate/render/view.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Neither NaN nor absurdly far away, so that squares and sums of a few stay finite.
bool usable(vec3 v) { return dot(v, v) < 1e18f; }

mat4 view_matrix(vec3 eye, const mat3& axes) { return translate(mat4(transpose(axes)), -eye); }

}  // namespace

Bounds bounds_of(std::span<const vec3> points) {
    Bounds box;
    for (vec3 p : points)
        if (usable(p)) box.include(p);
    return box;
}

Bounds bounds_of(const Ball& ball) {
    const vec3 corners[] = {ball.centre - ball.radius, ball.centre + ball.radius};
    return bounds_of(corners);
}

Extent around(const Bounds& box) {
    if (box.empty()) return {};
    return {box.centre(), std::max(0.5f * length(box.size()), 1e-6f)};
}

Extent extent(const Picture& picture, std::span<const Bounds> surfaces) {
    Bounds all;
    auto add = [&](const Bounds& box) {
        if (box.empty()) return;
        all.include(box.low);
        all.include(box.high);
    };
    for (const Bounds& box : surfaces) add(box);
    for (const Wires& some : picture.wires) add(bounds_of(some.points));
    for (const Ball& ball : picture.balls) add(bounds_of(ball));
    if (!all.empty() || !usable(picture.camera.eye) || !usable(picture.camera.look_at)) return around(all);
    return {picture.camera.look_at,
            std::max(0.3f * distance(picture.camera.eye, picture.camera.look_at), 1e-6f)};
}

mat3 axes(vec3 forward, vec3 up) {
    vec3 right = cross(forward, up);
    if (dot(right, right) < 1e-8f) {
        vec3 other = std::abs(forward.z) < 0.7f ? vec3(0, 0, 1) : vec3(1, 0, 0);
        right = cross(forward, other);
    }
    right = normalize(right);
    return mat3(right, cross(right, forward), -forward);
}

vec3 unit(vec3 v, vec3 otherwise) {
    float squared = dot(v, v);
    return std::isfinite(squared) && squared > 1e-30f ? v / std::sqrt(squared) : otherwise;
}

View view(const Camera& wanted, float aspect, const Extent& things) {
    const Camera camera = usable(wanted.eye) && usable(wanted.look_at) ? wanted : Camera{};
    const vec3 forward = unit(camera.look_at - camera.eye, vec3(0, 0, -1));
    const vec3 up = unit(camera.up, vec3(0, 1, 0));
    const float angle = glm::radians(camera.angle >= 1 ? std::min(camera.angle, 170.0f) : 1.0f);
    const float distance = std::max(length(camera.look_at - camera.eye), 1e-3f * things.radius);
    const float depth = dot(things.centre - camera.eye, forward);
    const mat4 to_eye = view_matrix(camera.eye, axes(forward, up));

    if (camera.orthographic) {
        const float half = distance * std::tan(0.5f * angle);
        mat4 parallel = glm::ortho(-half * aspect, half * aspect, -half, half, depth - things.radius,
                                   depth + things.radius);
        return {parallel * to_eye, vec4(-forward, 0), up};
    }
    // Also where the eye is among the things or past them, the view frustum must have some depth.
    const float far = std::max(depth + things.radius, 1e-2f * things.radius);
    const float near = std::max(depth - things.radius, 1e-3f * far);
    return {glm::perspective(angle, aspect, near, far) * to_eye, vec4(camera.eye, 1), up};
}

mat4 light_projection(vec3 direction, const Extent& things) {
    const float r = things.radius;
    return glm::ortho(-r, r, -r, r, -r, r) * view_matrix(things.centre, axes(direction, vec3(0, 1, 0)));
}

mat4 to_texture(const mat4& to_clip) {
    return translate(mat4(1), vec3(0.5f)) * scale(mat4(1), vec3(0.5f)) * to_clip;
}

}  // namespace palpate
