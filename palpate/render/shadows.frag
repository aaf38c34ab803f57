#version 450 core
// Soft shadows of the key light, from a shadow map by percentage-closer filtering.

layout(binding = 0) uniform sampler2DShadow shadow;  // 1 where the place is lit
layout(binding = 1) uniform sampler2D stopped;       // the same map, read as the depth at which the light was stopped

uniform mat4 to_shadow;      // from the world to the shadow map, 0 to 1 in each direction
uniform float shadow_texel;  // m; the width of one pixel of the map
uniform vec3 to_light;       // unit

// Samples on a golden-angle spiral, which fills the unit disc evenly.
const mat2 golden_turn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
float out_to(int i, int count) { return sqrt((i + 0.5) / count); }

// The share of the key light that reaches a place: percentage-closer filtering over a disc of `softness` pixels of
// the map.
float key_share(vec3 place, vec3 normal, float softness, int taps) {
    float facing = dot(normal, to_light);
    float sine = sqrt(max(1 - facing * facing, 0));
    float lift = shadow_texel * (1 + (1 + softness) * sine);  // the bias along the normal, so that a slope does not
                                                              // shadow itself
    vec3 seen = (to_shadow * vec4(place + lift * normal, 1)).xyz;
    seen.z = min(seen.z, 1);  // what lies behind the map's far plane can still be shadowed
    vec2 aside = vec2(softness / textureSize(shadow, 0).x, 0);
    float share = 0;
    for (int i = 0; i < taps; ++i) {
        share += texture(shadow, vec3(seen.xy + out_to(i, taps) * aside, seen.z));
        aside = golden_turn * aside;
    }
    return share / taps;
}

// The same by percentage-closer soft shadows (Fernando 2005): the farther away the blocker, the softer the edge of
// its shadow.
float soft_key_share(vec3 place, vec3 normal) {
    const int taps = 16;
    const float lamp = 0.07;  // its radius over its distance
    const float narrow = 2, wide = 26;
    float pixels = textureSize(stopped, 0).x;
    vec3 seen = (to_shadow * vec4(place, 1)).xyz;
    vec2 from_middle = abs(seen.xy - 0.5);
    if (max(from_middle.x, from_middle.y) > 0.5 + wide / pixels) return 1;  // the map holds everything that casts a
                                                                            // shadow
    vec2 aside = vec2(wide / pixels, 0);
    float above = 0, count = 0;
    for (int i = 0; i < taps; ++i) {
        float depth = texture(stopped, seen.xy + out_to(i, taps) * aside).x;
        if (depth < min(seen.z, 1)) {
            above += seen.z - depth;
            ++count;
        }
        aside = golden_turn * aside;
    }
    if (count == 0) return 1;
    return key_share(place, normal, clamp(lamp * pixels * above / count, narrow, wide), 40);
}
