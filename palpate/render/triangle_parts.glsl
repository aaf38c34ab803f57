// A part of a cluster, as TrianglePart in culling.cpp: its vertices on one triangle, the range of their barycentric
// weights of the second and third node, and how far at most they are from their places in the triangle.

struct Part {
    int nodes[3];
    float low[2], high[2];
    float reach;
};
layout(std430, binding = 3) readonly buffer Parts { Part parts[]; };

void include_part(int i, inout Box box) {
    vec3 a = node_position(parts[i].nodes[0]);
    vec3 along = node_position(parts[i].nodes[1]) - a, across = node_position(parts[i].nodes[2]) - a;
    for (int k = 0; k < 4; ++k) {
        float y = (k & 1) == 0 ? parts[i].low[0] : parts[i].high[0];
        float z = (k & 2) == 0 ? parts[i].low[1] : parts[i].high[1];
        vec3 place = a + y * along + z * across;
        include(box, place - parts[i].reach);
        include(box, place + parts[i].reach);
    }
}

// Unknown, as the basis of each triangle turns by itself.
bool faces_away(Cluster c, int first, int end, Box box) { return false; }
