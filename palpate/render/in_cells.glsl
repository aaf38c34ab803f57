// A vertex in a cell (trilinear), with the attributes of InCell.

layout(location = 0) in vec3 rest_normal;
layout(location = 2) in vec3 at;
layout(location = 3) in ivec4 low_nodes;
layout(location = 4) in ivec4 high_nodes;

MappedVertex follow(out vec3 normal) {
    vec3 corner[8];
    for (int k = 0; k < 4; ++k) {
        corner[k] = node_position(low_nodes[k]);
        corner[k + 4] = node_position(high_nodes[k]);
    }
    MappedVertex f = in_cell(corner, at.x, at.y, at.z);
    normal = normal_by_cofactors(f, rest_normal.x, rest_normal.y, rest_normal.z, rest_normal);
    return f;
}
