// A vertex on a triangle of nodes, with the attributes of OnTriangle: barycentric weights and an offset.

layout(location = 0) in vec3 rest_normal;
layout(location = 2) in vec3 weights;
layout(location = 3) in vec3 offset;
layout(location = 4) in float curvature;
layout(location = 5) in ivec3 nodes;

MappedVertex follow(out vec3 normal) {
    vec3 node[3], approximate = vec3(0);
    for (int k = 0; k < 3; ++k) {
        node[k] = node_position(nodes[k]);
        if (curvature > 0) approximate += weights[k] * clear_direction(node_normal(nodes[k]));
    }
    MappedVertex f = on_triangle(node[0], node[1], node[2], approximate, curvature);
    f.position = weights.x * node[0] + (weights.y * node[1] + weights.z * node[2]) +
                 expand(f, offset.x, offset.y, offset.z);
    normal = direction(expand(f, rest_normal.x, rest_normal.y, rest_normal.z), f.y);
    return f;
}
