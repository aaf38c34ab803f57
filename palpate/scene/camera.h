#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// Where a picture is seen from.
struct Camera {
    vec3 eye = vec3(0.3f, 0.2f, 0.4f);  // m
    vec3 look_at = vec3(0);             // m
    vec3 up = vec3(0, 1, 0);
    float angle = 35;           // degrees from the bottom of the picture to the top
    bool orthographic = false;  // then the picture is as high as `angle` shows at look_at
};

/// The axes of what stands upright where `up` (any length) is up: to the right, up, and towards somebody in
/// front of it. Where y is up they are x, y and z; where z is up, x, z and -y.
mat3 upright(vec3 up);

/// A light as far away as the sun.
struct Light {
    vec3 direction = vec3(0.55f, -1.0f, -0.35f);  // in which the light travels; need not be unit
    vec3 colour = vec3(1);                        // linear; 1 lights a white surface fully
};

}  // namespace palpate
