// Reads nodes from the flat textures of GpuNodes.

layout(binding = 2) uniform sampler2D node_positions;
layout(binding = 3) uniform sampler2D node_normals;

ivec2 texel_of(int node) {
    int width = textureSize(node_positions, 0).x;
    return ivec2(node % width, node / width);
}

vec3 node_position(int node) { return texelFetch(node_positions, texel_of(node), 0).xyz; }
vec3 node_normal(int node) { return texelFetch(node_normals, texel_of(node), 0).xyz; }
