#pragma once
#include "palpate/base/vectors.h"

namespace palpate {

/// A camera.
struct Camera {
    vec3 eye = vec3(0.3f, 0.2f, 0.4f);  // m
    vec3 look_at = vec3(0);             // m
    vec3 up = vec3(0, 1, 0);
    float angle = 35;           // degrees, the vertical field of view
    bool orthographic = false;  // a parallel projection; its height is that of `angle` at look_at
};

/// The axes right, up and towards the viewer, for an up direction of any length. If y is up, they are x, y
/// and z; if z is up, x, z and -y.
mat3 upright(vec3 up);

/// A directional light.
struct Light {
    vec3 direction = vec3(0.55f, -1.0f, -0.35f);  // the direction of its rays; need not be unit
    vec3 colour = vec3(1);                        // linear; 1 lights a white surface fully
};

}  // namespace palpate
