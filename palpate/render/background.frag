#version 450 core
// The background: a gradient that is brightest in the middle.

uniform vec2 picture;  // pixels

out vec4 colour;

vec3 shown(vec3 light);

void main() {
    vec2 place = (gl_FragCoord.xy / picture - vec2(0.5, 0.55)) * vec2(0.8, 1);
    float far = smoothstep(0.0, 0.75, length(place));
    colour = vec4(shown(mix(vec3(0.70, 0.715, 0.74), vec3(0.33, 0.345, 0.375), far)), 1);
}
