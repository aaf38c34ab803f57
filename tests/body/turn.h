#pragma once
#include "palpate/base/vectors.h"

#include <glm/gtc/matrix_transform.hpp>

#include <random>
#include <vector>

/// Any rigid motion: a turn about the origin, then a shift of up to a metre along each axis.
struct Turn {
    using vec3 = palpate::vec3;
    using vec4 = palpate::vec4;

    glm::mat4 turn;
    vec3 shift;
    explicit Turn(std::mt19937& random) {
        std::uniform_real_distribution<float> any(-1, 1);
        const vec3 axis = glm::normalize(vec3(any(random), any(random), any(random)) + vec3(1e-3f));
        turn = glm::rotate(glm::mat4(1), 3 * any(random), axis);
        shift = vec3(any(random), any(random), any(random));
    }
    vec3 direction(vec3 v) const { return vec3(turn * vec4(v, 0)); }
    std::vector<vec3> points(const std::vector<vec3>& list) const {
        std::vector<vec3> out;
        for (vec3 p : list) out.push_back(direction(p) + shift);
        return out;
    }
    std::vector<vec3> directions(const std::vector<vec3>& list) const {
        std::vector<vec3> out;
        for (vec3 v : list) out.push_back(direction(v));
        return out;
    }
};
