#include "palpate/body/collider.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/solid.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace palpate {

float DistanceField::at(vec3 p) const {
    if (std::min({dims.x, dims.y, dims.z}) < 2)
        throw Error("fewer than 2 points along an axis", "a distance field", "give it more");
    const vec3 way = (p - origin) / spacing;
    vec3 place;  // a motion that diverges brings points that are not finite: they count as the first corner
    for (int k = 0; k < 3; ++k) place[k] = way[k] > 0 ? std::min(way[k], float(dims[k] - 1)) : 0;
    const ivec3 cell = glm::min(ivec3(place), dims - 2);
    const vec3 part = place - vec3(cell);
    float sum = 0;
    for (int k = 0; k < 8; ++k) {
        const ivec3 side = cell_corner(k), c = cell + side;
        const vec3 w = glm::mix(1.0f - part, part, vec3(side));
        sum += w.x * w.y * w.z * distance[(std::size_t(c.z) * dims.y + c.y) * dims.x + c.x];
    }
    return sum;
}

vec3 DistanceField::gradient(vec3 p) const {
    const float h = 0.5f * spacing;
    auto across = [&](vec3 way) { return at(p + way) - at(p - way); };
    return {across({h, 0, 0}), across({0, h, 0}), across({0, 0, h})};
}

DistanceField distance_field(const Mesh& mesh, float spacing) {
    const SignedDistance signed_distance(mesh, spacing);
    const Bounds box = bounds(mesh);
    DistanceField field;
    field.spacing = spacing;
    field.origin = box.low - 3 * spacing;
    field.dims = ivec3(glm::ceil(box.size() / spacing)) + 7;
    field.distance = signed_distance.sample(field.origin, spacing, field.dims);
    return field;
}

Motion after(const Motion& motion, float seconds) {
    Motion later = motion;
    later.position += seconds * motion.velocity;
    const float angle = seconds * glm::length(motion.spin);
    if (angle > 0)
        later.rotation = mat3(glm::rotate(mat4(1), angle, glm::normalize(motion.spin))) * motion.rotation;
    return later;
}

}  // namespace palpate
