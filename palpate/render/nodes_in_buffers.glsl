// Reads nodes from the buffers of GpuNodes.

layout(std430, binding = 0) readonly buffer NodePositions { vec4 node_positions[]; };
layout(std430, binding = 1) readonly buffer NodeNormals { vec4 node_normals[]; };

vec3 node_position(int node) { return node_positions[node].xyz; }
vec3 node_normal(int node) { return node_normals[node].xyz; }
