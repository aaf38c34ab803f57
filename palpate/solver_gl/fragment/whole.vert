// whole.vert: one triangle that covers the whole texture.

void main() { gl_Position = vec4(4 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1, 0, 1); }
