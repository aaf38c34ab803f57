#version 450 core
// A corner of anything, for shadow maps.

layout(location = 0) in vec3 position;

uniform mat4 to_clip;
uniform vec3 centre;  // see surface.vert
uniform float size;

void main() { gl_Position = to_clip * vec4(centre + size * position, 1); }
