#pragma once
// Vectors and matrices with GLSL's names, from glm.
#include <glm/glm.hpp>

#include <limits>
#include <span>

namespace palpate {

using glm::dmat2;
using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// An axis-aligned bounding box (AABB). A new one is empty: `low` is above `high`.
struct Bounds {
    vec3 low = vec3(std::numeric_limits<float>::max());
    vec3 high = vec3(std::numeric_limits<float>::lowest());

    bool empty() const { return !(low.x <= high.x); }
    vec3 size() const { return empty() ? vec3(0) : high - low; }
    vec3 centre() const { return 0.5f * (low + high); }
    void include(vec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

/// The bounding box of points.
inline Bounds bounds(std::span<const vec3> points) {
    Bounds box;
    for (vec3 p : points) box.include(p);
    return box;
}

}  // namespace palpate
