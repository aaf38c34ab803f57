// closing.comp: the results of a call: where the nodes are, for drawing, and what the host
// asks. Each invocation takes every so manieth node, so that few of them meet at the atomics.

layout(local_size_x = group_size) in;
layout(binding = slots_unit) uniform isamplerBuffer slots;  // of the nodes
layout(binding = before_unit) uniform Floats before;         // their positions before the last step
layout(std430, binding = shown_positions_buffer) writeonly buffer Positions { vec4 shown_positions[]; };
layout(std430, binding = shown_normals_buffer) writeonly buffer Normals { vec4 shown_normals[]; };
layout(std430, binding = findings_buffer) buffer Findings {
    uint diverged, speed, move;  // the two as floats' bits, which are in order where they are not negative
    int low[3], high[3];     // of the box around all, ordered()
    float first_node[3], first_velocity[3];
};
uniform int count;
uniform vec3 zero;       // m: what places are counted from, in the world,
uniform vec3 zero_speed; // m/s: at which that went on,
uniform float duration;  // s, of the last step

// A float's bits as a whole number in the same order.
int ordered(float a) {
    int bits = floatBitsToInt(a);
    return bits ^ (bits >> 31 & 0x7fffffff);
}

void main() {
    int first = int(gl_GlobalInvocationID.x), stride = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    if (first >= count) return;
    uint wrong = 0u;
    float fastest = 0, furthest = 0;
    vec3 least = vec3(3e38), most = vec3(-3e38);
    for (int i = first; i < count; i += stride) {
        look_at(texelFetch(slots, i).x);
        vec3 position = at(positions, id).xyz, velocity = at(velocities, id).xyz;
        vec3 shown = zero + position;
        shown_positions[i] = vec4(shown, 1);
        shown_normals[i] = vec4(outward(position), 0);
        if (torn(position) > 0) wrong = 1u;
        fastest = max(fastest, length(velocity + zero_speed));
        furthest = max(furthest, distance(position + duration * zero_speed, at(before, id).xyz));
        least = min(least, shown);
        most = max(most, shown);
        if (i > 0) continue;
        first_node = float[3](position.x, position.y, position.z);
        first_velocity = float[3](velocity.x, velocity.y, velocity.z);
    }
    if (wrong > 0u) atomicOr(diverged, 1u);
    atomicMax(speed, floatBitsToUint(fastest));
    atomicMax(move, floatBitsToUint(furthest));
    for (int k = 0; k < 3; ++k) {
        atomicMin(low[k], ordered(least[k]));
        atomicMax(high[k], ordered(most[k]));
    }
}
