#version 450 core
// A thin line. It pales with distance, so that a lattice shows its near side and not a tangle.

in float nearness;

uniform vec3 albedo;
uniform float far;   // the opacity at the far side of the things; below 0 to vanish before
uniform float near;  // and at the near side

out vec4 colour;

vec3 shown(vec3 light);

void main() { colour = vec4(shown(albedo), max(mix(far, near, smoothstep(-0.7, 0.3, nearness)), 0)); }
