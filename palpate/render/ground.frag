#version 450 core
// The ground below the things. It fades towards its rim.

in vec3 place;
in vec2 out_from_middle;

uniform vec4 eye;  // see View
uniform vec3 upright;

out vec4 colour;

vec3 lit(vec3 normal, vec3 to_eye, vec3 albedo, float shine, float sky, float share);
float sky_share(vec3 place, vec3 normal);
float soft_key_share(vec3 place, vec3 normal);
vec3 shown(vec3 light);

void main() {
    float there = 1 - smoothstep(0.15, 1.0, length(out_from_middle));
    if (there <= 0) discard;
    vec3 to_eye = normalize(eye.xyz - eye.w * place);
    float sky = sky_share(place, upright);
    float share = soft_key_share(place, upright);
    vec3 light = lit(upright, to_eye, vec3(0.56, 0.565, 0.575), 0, sky, share);
    colour = vec4(shown(light), there);
}
