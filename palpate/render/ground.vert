#version 450 core
// A square on the ground, wide enough for everything of it that shows.

uniform mat4 to_clip;
uniform vec3 middle;
uniform vec3 along;   // to the middle of one edge
uniform vec3 across;  // to the middle of the next

out vec3 place;
out vec2 out_from_middle;  // 1 at the rim

void main() {
    out_from_middle = 2 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1;
    place = middle + out_from_middle.x * along + out_from_middle.y * across;
    gl_Position = to_clip * vec4(place, 1);
}
