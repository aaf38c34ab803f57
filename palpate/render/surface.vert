#version 450 core
// A corner of a surface or of a ball. What it is linked with says where that is.

layout(location = 8) in float openness;
layout(location = 9) in vec2 texture_place;

uniform mat4 to_clip;

out vec3 place;
out vec3 facing;
out vec4 along_u;
out vec2 uv;
out float sky;  // the share of it that the place sees

void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent);
float sky_share(vec3 place, vec3 normal);

void main() {
    map_vertex(place, facing, along_u);
    uv = texture_place;
    // What the surface at rest leaves of the sky, with more contrast than nature's so that grooves read as
    // grooves, and what the tools leave of that. It is smooth, so that once a vertex is enough.
    sky = openness * openness * sky_share(place, facing);
    gl_Position = to_clip * vec4(place, 1);
}
