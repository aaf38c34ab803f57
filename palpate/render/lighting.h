#pragma once
#include "palpate/gl/program.h"
#include "palpate/render/picture.h"
#include "palpate/render/view.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// How the light of a picture falls.
struct Lighting {
    vec3 to_light;              // unit
    vec3 key;                   // the light's colour
    mat4 to_clip;               // from the world to the shadow map's clip space
    float texel;                // m; how wide a pixel of the shadow map is
    std::vector<Bounds> round;  // the round things that hide the sky: first the balls, then the surfaces
};

/// For a shadow map of `pixels` a side, which what casts shadows fills. `surfaces`: the box around each of
/// the picture's.
Lighting lighting(const Picture& picture, std::span<const Bounds> surfaces, int pixels);

/// Sets all uniforms of light.frag and sky.glsl, and those of `view`. The first `occluders` of the round
/// things hide the sky of what the program draws.
void tell(const gl::Program& program, const View& view, const Lighting& light, std::size_t occluders);

}  // namespace palpate
