// A part of a cluster, as CellPart in culling.cpp: its vertices in one cell, and the box of their places in that
// cell. As the map is trilinear, the hull of the box's mapped corners contains the vertices.

struct Part {
    int nodes[8];
    float low[3], high[3];
    float origin[3];
};
layout(std430, binding = 3) readonly buffer Parts { Part parts[]; };

vec3 low(int i) { return vec3(parts[i].low[0], parts[i].low[1], parts[i].low[2]); }
vec3 high(int i) { return vec3(parts[i].high[0], parts[i].high[1], parts[i].high[2]); }
vec3 origin(int i) { return vec3(parts[i].origin[0], parts[i].origin[1], parts[i].origin[2]); }

// The eight corners of a part's box: at rest, in cells; and now.
vec3 at_rest(int i, int k) { return origin(i) + mix(low(i), high(i), vec3(k & 1, k >> 1 & 1, k >> 2 & 1)); }
void corners(int i, out vec3 now[8]) {
    for (int k = 0; k < 8; ++k) now[k] = node_position(parts[i].nodes[k]);
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 8; ++k) {
            int other = k | 1 << axis;
            if (other == k) continue;
            vec3 from = now[k], way = now[other] - from;
            now[k] = from + parts[i].low[axis] * way;
            now[other] = from + parts[i].high[axis] * way;
        }
}

void include_part(int i, inout Box box) {
    vec3 now[8];
    corners(i, now);
    for (int k = 0; k < 8; ++k) include(box, now[k]);
}

mat3 gradient(int i) {
    vec3 corner[8], at = 0.5 * (low(i) + high(i));
    for (int k = 0; k < 8; ++k) corner[k] = node_position(parts[i].nodes[k]);
    MappedVertex f = in_cell(corner, at.x, at.y, at.z);
    return mat3(f.x, f.y, f.z);
}

// Whether all triangles of a cluster are back faces, however it is deformed. The deformation is one gradient for the
// whole cluster, plus a remainder for each vertex. The remainders of two vertices differ at most by the size of their
// box, which bounds by how much the normal of a triangle may differ from the one that the gradient alone gives.
bool faces_away(Cluster c, int first, int end, Box box) {
    if (!(c.sharpness > 0)) return false;
    mat3 mean = gradient((first + end) / 2);  // any would do, but one near the mean gives the tightest bound
    Box rests = no_box();
    for (int i = first; i < end; ++i) {
        vec3 now[8];
        corners(i, now);
        for (int k = 0; k < 8; ++k) include(rests, now[k] - mean * at_rest(i, k));
    }
    float rest = length(rests.high - rests.low) + 1e-6 * length(max(abs(box.low), abs(box.high)));
    mat3 cofactors = mat3(cross(mean[1], mean[2]), cross(mean[2], mean[0]), cross(mean[0], mean[1]));
    float stretch = sqrt(dot(mean[0], mean[0]) + dot(mean[1], mean[1]) + dot(mean[2], mean[2]));
    float most = sqrt(dot(cofactors[0], cofactors[0]) + dot(cofactors[1], cofactors[1]) +
                      dot(cofactors[2], cofactors[2]));
    // Rounding to pixels may flip a triangle that is seen edge-on: the last term is the margin for that.
    float off = rest * (stretch * c.sharpness + rest * c.smallness) + 0.05 * most;

    // From the eye to the middle of the cluster, and how far any of it is from there.
    vec3 away = eye.w * 0.5 * (box.low + box.high) - eye.xyz;
    float radius = eye.w * 0.5 * length(box.high - box.low);
    vec3 axis = vec3(c.axis[0], c.axis[1], c.axis[2]), toward = transpose(cofactors) * away;
    float along = dot(axis, toward), across = length(toward - along * axis);
    return along * c.cosine - across * c.sine > off * length(away) + (most + off) * radius;
}
