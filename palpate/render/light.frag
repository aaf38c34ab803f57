#version 450 core
// How a place on anything is lit: by a key light with soft shadows and by the sky, with glints where it is wet.

layout(binding = 0) uniform sampler2DShadow shadow;  // whether light gets there
layout(binding = 1) uniform sampler2D stopped;       // the same map, but where the light was stopped

uniform mat4 to_shadow;      // from the world to the shadow map, 0 to 1 in each direction
uniform float shadow_texel;  // m; the width of one pixel of the map
uniform vec3 to_light;       // unit
uniform vec3 key;            // the light's colour
uniform vec3 up;             // unit

// Steps on a spiral that fills the unit disc evenly, no two of them in line with an edge.
const mat2 golden_turn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
float out_to(int i, int count) { return sqrt((i + 0.5) / count); }

// The share of the key light that gets to a place, averaged over a disc of `softness` pixels of the map.
float key_share(vec3 place, vec3 normal, float softness, int taps) {
    float facing = dot(normal, to_light);
    float sine = sqrt(max(1 - facing * facing, 0));
    float lift = shadow_texel * (1 + (1 + softness) * sine);  // so that a slope does not shadow itself
    vec3 seen = (to_shadow * vec4(place + lift * normal, 1)).xyz;
    seen.z = min(seen.z, 1);  // what lies beyond the map can still be shadowed
    vec2 aside = vec2(softness / textureSize(shadow, 0).x, 0);
    float share = 0;
    for (int i = 0; i < taps; ++i) {
        share += texture(shadow, vec3(seen.xy + out_to(i, taps) * aside, seen.z));
        aside = golden_turn * aside;
    }
    return share / taps;
}

// The same, where the edge of a shadow is the softer the farther off the thing is that casts it.
float soft_key_share(vec3 place, vec3 normal) {
    const int taps = 16;
    const float lamp = 0.07;  // its radius over its distance
    const float narrow = 2, wide = 26;
    float pixels = textureSize(stopped, 0).x;
    vec3 seen = (to_shadow * vec4(place, 1)).xyz;
    vec2 from_middle = abs(seen.xy - 0.5);
    if (max(from_middle.x, from_middle.y) > 0.5 + wide / pixels) return 1;  // the map holds all that casts a shadow
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

// The share of the sky's light that a groove with some share of the sky gives back: in it, light bounces and
// takes on the thing's colour, the more the brighter that is (Jimenez et al. 2016, multiple bounces).
vec3 bounced(float sky, vec3 look) {
    vec3 a = 2.0404 * look - 0.3324, b = -4.7951 * look + 0.6417, c = 2.7552 * look + 0.6903;
    return max(vec3(sky), ((sky * a + b) * sky + c) * sky);
}

// A lamp's glint on a rough surface (GGX), for a lamp that a white surface reflects as 1.
float glint(vec3 normal, vec3 to_eye, float facing, float facing_eye, float rough) {
    float halfway = max(dot(normal, normalize(to_light + to_eye)), 0);
    float a = rough * rough, k = 0.5 * a;
    float spread = a / (halfway * halfway * (a * a - 1) + 1);
    return 0.25 * spread * spread / ((facing_eye * (1 - k) + k) * (facing * (1 - k) + k));
}

// What a mirror would show: a bright ceiling above a dim floor, blurred by the roughness.
vec3 studio(vec3 direction, float rough) {
    float height = dot(direction, up);
    return mix(vec3(0.10, 0.095, 0.09), vec3(0.9, 0.95, 1.05), smoothstep(0.1 - rough, 0.5 + rough, height));
}

// Light that leaves a place for the eye. `look` is its colour, `sky` and `share` are the shares of the sky and of
// the key light that get there.
vec3 lit(vec3 normal, vec3 to_eye, vec3 look, float shine, float sky, float share) {
    float facing = max(dot(normal, to_light), 0);
    float facing_eye = max(dot(normal, to_eye), 1e-3);

    // Light that enters soft tissue leaves it nearby in the colour that it absorbs least: shade begins warm.
    float direct = facing * share;
    float least = min(look.r, min(look.g, look.b)), most = max(look.r, max(look.g, look.b));
    vec3 seeping = direct * (1 + (1 - direct) * (look - least) / max(most, 1e-3));

    vec3 ambient = mix(vec3(0.13, 0.12, 0.115), vec3(0.46, 0.48, 0.52), 0.5 + 0.5 * dot(normal, up));
    vec3 matt = look * (key * seeping + ambient * bounced(sky, look));

    float rough = mix(0.6, 0.15, shine);
    float grazing = (1 - facing_eye) * (1 - facing_eye);
    float mirror = 0.05 + 0.6 * grazing * grazing * (1 - facing_eye);
    vec3 mirrored = key * (direct * glint(normal, to_eye, facing, facing_eye, rough)) +
                    studio(reflect(-to_eye, normal), rough) * (sky * sky);
    return matt + shine * mirror * mirrored;
}
