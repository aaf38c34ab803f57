#version 450 core
// points.frag: see points.vert.
layout(location = 0) out vec4 colour;

void main() { colour = vec4(1, 0.8, 0.3, 1); }
