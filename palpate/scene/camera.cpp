#include "palpate/scene/camera.h"

#include <cmath>

namespace palpate {

mat3 upright(vec3 up) {
    const vec3 y = glm::normalize(up), x(1, 0, 0), z(0, 0, 1);
    if (std::abs(y.x) < 0.9f) {
        const vec3 right = glm::normalize(x - glm::dot(x, y) * y);
        return {right, y, glm::cross(right, y)};
    }
    const vec3 front = glm::normalize(z - glm::dot(z, y) * y);
    return {glm::cross(y, front), y, front};
}

}  // namespace palpate
