#version 450 core
// A surface or a ball.

in vec3 place;
in vec3 upright;
in float sky;  // the share of it that the place sees

uniform vec4 eye;  // see View
uniform vec3 to_light;
uniform vec3 look;
uniform float shine;

out vec4 colour;

vec3 lit(vec3 normal, vec3 to_eye, vec3 look, float shine, float sky, float share);
float key_share(vec3 place, vec3 normal, float softness, int taps);
vec3 shown(vec3 light);

void main() {
    vec3 to_eye = normalize(eye.xyz - eye.w * place);
    vec3 normal = gl_FrontFacing ? upright : -upright;
    normal = dot(normal, normal) > 0 ? normalize(normal) : to_eye;
    float share = dot(normal, to_light) > 0 ? key_share(place, normal, 2.5, 10) : 0;
    colour = vec4(shown(lit(normal, to_eye, look, shine, sky, share)), 1);
}
