// Maps a vertex of a surface, with its normal and tangent: the end of GpuEmbedding::shader().

layout(location = 1) in vec4 rest_tangent;

void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent) {
    MappedVertex f = follow(normal);
    position = f.position;
    tangent = vec4(upright(expand(f, rest_tangent.x, rest_tangent.y, rest_tangent.z), normal), rest_tangent.w);
}
