// Whether anything of each cluster can be seen.

layout(local_size_x = 64) in;

layout(std430, binding = 4) readonly buffer Clusters { Cluster clusters[]; };

// As glMultiDrawElementsIndirect takes it.
struct Command {
    uint count, instances, first_index;
    int base_vertex;
    uint base_instance;
};
layout(std430, binding = 5) buffer Commands { Command commands[]; };

uniform bool hides_backs;  // whether triangles that show their backs are not drawn

// Beyond one of the sides of what is seen.
bool outside(Box box) {
    vec3 rounding = 1e-5 * (box.high - box.low) + 1e-6 * max(abs(box.low), abs(box.high));
    vec3 low = box.low - rounding, high = box.high + rounding;
    vec3 most = vec3(-3e38), least = vec3(3e38);  // of x, y, z from the two planes of each axis, inwards
    for (int k = 0; k < 8; ++k) {
        vec4 p = to_clip * vec4(mix(low, high, vec3(k & 1, k >> 1 & 1, k >> 2 & 1)), 1);
        most = max(most, p.xyz + p.w);
        least = min(least, p.xyz - p.w);
    }
    return any(lessThan(most, vec3(0))) || any(greaterThan(least, vec3(0)));
}

void main() {
    int c = int(gl_GlobalInvocationID.x);
    if (c >= clusters.length()) return;
    int first = c > 0 ? clusters[c - 1].parts_end : 0, end = clusters[c].parts_end;
    Box box = no_box();
    for (int i = first; i < end; ++i) include_part(i, box);
    bool hidden = outside(box) || hides_backs && faces_away(clusters[c], first, end, box);
    commands[c].instances = hidden ? 0 : 1;
}
