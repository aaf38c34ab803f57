#include "palpate/viewer/orbit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

vec3 unit(vec3 v, vec3 otherwise) {
    const float length = glm::length(v);
    return length > 1e-12f ? v / length : otherwise;
}

// The frame of a camera.
struct Axes {
    vec3 right, up, forward;
    float distance;  // m, from the eye to what it looks at
    float slope;     // the tangent of half the vertical field of view

    explicit Axes(const Camera& camera) {
        const vec3 to = camera.look_at - camera.eye;
        forward = unit(to, vec3(0, 0, -1));
        distance = std::max(glm::length(to), 1e-6f);
        vec3 aside = glm::cross(forward, unit(camera.up, vec3(0, 1, 0)));
        if (glm::length(aside) < 1e-4f)
            aside = glm::cross(forward, std::abs(forward.z) < 0.7f ? vec3(0, 0, 1) : vec3(1, 0, 0));
        right = glm::normalize(aside);
        up = glm::cross(right, forward);
        slope = std::tan(0.5f * glm::radians(std::clamp(camera.angle, 1.0f, 170.0f)));
    }
};

vec3 turned(vec3 v, vec3 axis, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return c * v + s * glm::cross(axis, v) + (1 - c) * glm::dot(axis, v) * axis;
}

}  // namespace

vec3 forward_of(const Camera& camera) { return Axes(camera).forward; }

Ray ray_through(const Camera& camera, vec2 pixel, ivec2 size) {
    const Axes axes(camera);
    const vec2 half = 0.5f * vec2(glm::max(size, ivec2(1)));
    const vec2 aside = (pixel - half) / half.y * vec2(1, -1) * axes.slope;
    const vec3 off = aside.x * axes.right + aside.y * axes.up;
    if (camera.orthographic) return {camera.eye + axes.distance * off, axes.forward};
    return {camera.eye, glm::normalize(axes.forward + off)};
}

std::optional<vec2> pixel_of(const Camera& camera, vec3 point, ivec2 size) {
    const Axes axes(camera);
    const vec3 to = point - camera.eye;
    const float depth = camera.orthographic ? axes.distance : glm::dot(to, axes.forward);
    if (!(depth > 0)) return std::nullopt;
    const vec2 half = 0.5f * vec2(size);
    const vec2 aside = vec2(glm::dot(to, axes.right), -glm::dot(to, axes.up)) / (depth * axes.slope);
    return half + half.y * aside;
}

namespace {

// Coordinates across a ray, m: the ray is at zero.
std::vector<vec2> across(const Ray& ray, std::span<const vec3> points) {
    const vec3 aside = std::abs(ray.along.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 right = glm::normalize(glm::cross(ray.along, aside)), up = glm::cross(right, ray.along);
    std::vector<vec2> places(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        places[i] = {glm::dot(points[i] - ray.from, right), glm::dot(points[i] - ray.from, up)};
    return places;
}

bool surround_zero(vec2 a, vec2 b, vec2 c) {
    const vec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    return low.x <= 0 && low.y <= 0 && high.x >= 0 && high.y >= 0;
}

// The distance along a ray to a triangle (Möller and Trumbore 1997); nothing if it misses.
std::optional<float> way_to(const Ray& ray, vec3 a, vec3 e, vec3 f) {
    const vec3 p = glm::cross(ray.along, f);
    const float det = glm::dot(e, p);
    if (det == 0) return std::nullopt;
    const vec3 to = (ray.from - a) / det;
    const float u = glm::dot(to, p);
    const vec3 q = glm::cross(to, e);
    const float v = glm::dot(ray.along, q), way = glm::dot(f, q);
    if (!(u >= 0 && v >= 0 && u + v <= 1 && way > 0)) return std::nullopt;
    return way;
}

}  // namespace

// All triangles are tested, most of them only by a quick rejection in ray coordinates: a millisecond for
// 100,000.
std::optional<Hit> pick(const Ray& ray, std::span<const Skin> skins) {
    std::optional<Hit> hit;
    for (std::size_t s = 0; s < skins.size(); ++s) {
        const std::vector<vec3>& positions = skins[s].positions;
        const std::vector<vec2> places = across(ray, positions);
        for (const uvec3 t : *skins[s].triangles) {
            if (!surround_zero(places[t.x], places[t.y], places[t.z])) continue;
            const vec3 a = positions[t.x], e = positions[t.y] - a, f = positions[t.z] - a;
            const auto way = way_to(ray, a, e, f);
            if (!way || (hit && *way >= hit->way)) continue;
            vec3 normal = unit(glm::cross(e, f), -ray.along);
            if (glm::dot(normal, ray.along) > 0) normal = -normal;
            hit = {*way, s, t, ray.at(*way), normal};
        }
    }
    return hit;
}

Bounds bounds_of(std::span<const Skin> skins) {
    Bounds box;
    for (const Skin& skin : skins)
        for (vec3 p : skin.positions) box.include(p);
    return box;
}

void Orbit::turn(vec2 pixels, int height) {
    const Axes axes(camera_);
    const float scale = 3.5f / float(std::max(height, 1));  // radians a pixel
    const vec3 sky = unit(camera_.up, vec3(0, 1, 0));
    vec3 back = turned(-axes.forward, sky, -pixels.x * scale);
    const vec3 right = unit(glm::cross(sky, back), axes.right);
    constexpr float pole = 0.02f;  // radians
    const float above = std::asin(std::clamp(glm::dot(back, sky), -1.0f, 1.0f));
    const float limit = 0.5f * 3.14159265f - pole;
    const float wanted = std::clamp(above + pixels.y * scale, -limit, limit);
    back = turned(back, right, above - wanted);
    camera_.eye = camera_.look_at + axes.distance * glm::normalize(back);
}

void Orbit::pan(vec2 pixels, int height) {
    const Axes axes(camera_);
    const float scale = 2 * axes.slope * axes.distance / float(std::max(height, 1));  // m a pixel
    const vec3 shift = scale * (pixels.y * axes.up - pixels.x * axes.right);
    camera_.eye += shift;
    camera_.look_at += shift;
}

void Orbit::zoom(float notches) {
    const vec3 back = camera_.eye - camera_.look_at;
    const float factor = std::pow(0.88f, std::clamp(notches, -20.0f, 20.0f));
    const float distance = glm::length(back) * factor;
    if (distance > 1e-4f && distance < 1e4f) camera_.eye = camera_.look_at + factor * back;
}

void Orbit::frame(const Bounds& box) {
    if (box.empty()) return;
    const Axes axes(camera_);
    const float radius = std::max(0.5f * glm::length(box.size()), 1e-4f);
    camera_.look_at = box.centre();
    camera_.eye = camera_.look_at - 1.1f * radius / std::sin(std::atan(axes.slope)) * axes.forward;
}

}  // namespace palpate
