#pragma once
#include "palpate/gl/program.h"
#include "palpate/render/picture.h"
#include "palpate/render/view.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// The light of a picture, as shaders need it.
struct Lighting {
    vec3 to_light;              // unit
    vec3 key;                   // the light's colour
    mat4 to_clip;               // from the world to the shadow map's clip space
    float texel;                // m; the width of a pixel of the shadow map
    std::vector<Bounds> round;  // the bounding boxes of things that hide the sky as ellipsoids (ambient
                                // occlusion): first the balls, then the surfaces
};

/// For a shadow map of `pixels` a side, fitted to what casts shadows. `surfaces`: the bounding box of each of
/// the picture's.
Lighting lighting(const Picture& picture, std::span<const Bounds> surfaces, int pixels);

/// Sets all uniforms of light.frag and sky.glsl, and those of `view`. The first `occluders` of `light.round`
/// hide the sky from what the program draws.
void set_uniforms(const gl::Program& program, const View& view, const Lighting& light, std::size_t occluders);

}  // namespace palpate
