// View-frustum and back-face culling, for one cluster per invocation.

layout(local_size_x = 64) in;

layout(std430, binding = 4) readonly buffer Clusters { Cluster clusters[]; };

// As glMultiDrawElementsIndirect takes it.
struct Command {
    uint count, instances, first_index;
    int base_vertex;
    uint base_instance;
};
layout(std430, binding = 5) writeonly buffer Commands { Command commands[]; };

uniform bool culls_back_faces;  // whether back faces are not drawn
uniform float moved;       // m; how far vertices may lie from where the embedding puts them

// Whether the box lies wholly beyond one plane of the view frustum.
bool outside_frustum(Box box) {
    vec3 rounding = 1e-5 * (box.high - box.low) + 1e-6 * max(abs(box.low), abs(box.high));
    vec3 low = box.low - rounding - moved, high = box.high + rounding + moved;
    vec3 most = vec3(-3e38), least = vec3(3e38);  // for x, y and z: the greatest and the least signed distance from
                                                  // the two planes of that axis
    for (int k = 0; k < 8; ++k) {
        vec4 p = to_clip * vec4(mix(low, high, vec3(k & 1, k >> 1 & 1, k >> 2 & 1)), 1);
        most = max(most, p.xyz + p.w);
        least = min(least, p.xyz - p.w);
    }
    return any(lessThan(most, vec3(0))) || any(greaterThan(least, vec3(0)));
}

bool hidden(int c) {
    int first = c > 0 ? clusters[c - 1].parts_end : 0, end = clusters[c].parts_end;
    Box box = no_box();
    for (int i = first; i < end; ++i) include_part(i, box);
    return outside_frustum(box) || culls_back_faces && faces_away(clusters[c], first, end, box);
}

shared bool drawn[gl_WorkGroupSize.x];

// A draw call costs more than a few triangles, so neighbouring clusters that are drawn share one: the command of the
// first draws them all.
void main() {
    int c = int(gl_GlobalInvocationID.x), here = int(gl_LocalInvocationID.x);
    bool exists = c < clusters.length();
    drawn[here] = exists && !hidden(c);
    barrier();
    if (!exists) return;
    bool begins = drawn[here] && (here == 0 || !drawn[here - 1]);
    int first = c > 0 ? clusters[c - 1].corners_end : 0, end = first;
    if (begins)
        for (; here < drawn.length() && drawn[here]; ++here) end = clusters[c++].corners_end;
    commands[gl_GlobalInvocationID.x] = Command(uint(end - first), begins ? 1 : 0, uint(first), 0, 0);
}
