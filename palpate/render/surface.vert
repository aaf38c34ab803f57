#version 450 core
// A corner of a surface, or of a ball: the unit ball, made as big as `size` and moved to `centre`.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float openness;

uniform mat4 to_clip;
uniform vec3 centre;  // 0 for a surface
uniform float size;   // 1 for a surface

out vec3 place;
out vec3 upright;
out float sky;  // the share of it that the place sees

float sky_share(vec3 place, vec3 normal);

void main() {
    place = centre + size * position;
    upright = normal;
    // What the surface at rest leaves of the sky, with more contrast than nature's so that grooves read as
    // grooves, and what the tools leave of that. It is smooth, so that once a vertex is enough.
    sky = openness * openness * sky_share(place, normal);
    gl_Position = to_clip * vec4(place, 1);
}
