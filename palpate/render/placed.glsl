#version 450 core
// A vertex whose position is an attribute: of a surface that was mapped on the host, or of a ball, which is the unit
// ball scaled by `size` and moved to `centre`.

layout(location = 0) in vec3 given_position;
layout(location = 1) in vec3 given_normal;

uniform vec3 centre;  // 0 for a surface
uniform float size;   // 1 for a surface

void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent) {
    position = centre + size * given_position;
    normal = given_normal;
    tangent = vec4(0);
}
