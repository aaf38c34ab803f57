#version 450 core
// points.vert: nodes as points.
layout(location = 0) in vec3 node_position;  // m
uniform mat4 to_clip;

void main() { gl_Position = to_clip * vec4(node_position, 1); }
