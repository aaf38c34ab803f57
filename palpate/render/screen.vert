#version 450 core
// One triangle that covers the whole picture, on the far plane.

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4 * corner - 1, 1, 1);
}
