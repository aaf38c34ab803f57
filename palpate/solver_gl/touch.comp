// touch.comp: the impulses that tips and pushes give to the nodes in one pass. Each invocation adds up those that a tip
// gives to every so manieth node of those that it may touch (Placement::rim); the host adds up the sums. Pushes are gone through
// one by one.

layout(local_size_x = group_size) in;
layout(binding = rim_unit) uniform isamplerBuffer rim;  // their slots
layout(binding = start_velocities_unit) uniform Floats start_velocities;
layout(std430, binding = impulses_buffer) buffer Impulses { vec4 impulses[]; };  // N s: of each push; then by tips, of each invocation
uniform int count;         // of those nodes
uniform int first_push;    // in `pushes`, of those that were handed in,
uniform int pushes_given;  // and how many those are
uniform float seconds;     // over which the forces act

// What tips resist depends on all that acts on a node.
void add_resistance(int first, int stride) {
    for (int k = first; k < count; k += stride) {
        look_at(texelFetch(rim, k).x);
        Node node = node_of(Kept(at(positions, id), at(velocities, id))), start = node;
        start.velocity = velocity_of(at(start_velocities, id));
        bool touched = false;
        for (int i = 0; i < TIPS; ++i) touched = touched || at_tip(node.position, tip(i)).depth > 0;
        if (!touched) continue;
        vec3 change = acceleration(node);
        for (int i = 0; i < TIPS; ++i) {
            vec3 force = tip_resistance(start, node.position, change, i);
            impulses[pushes_given + i * stride + first].xyz += seconds * force;
            change += node.inverse_mass * force;
        }
    }
}

void main() {
    int first = int(gl_GlobalInvocationID.x), stride = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    for (int p = first; p < pushes_given; p += stride) {
        vec4 to = texelFetch(pushes, 3 * (first_push + p)), velocity = texelFetch(pushes, 3 * (first_push + p) + 1);
        vec3 force = texelFetch(pushes, 3 * (first_push + p) + 2).xyz;
        vec3 position = at(positions, floatBitsToInt(velocity.w)).xyz;
        impulses[p].xyz += seconds * (force + to.w * (to.xyz + pass.time * velocity.xyz - position));
    }
    for (int i = 0; i < TIPS; ++i) {
        vec3 sum = vec3(0);
        for (int k = first; k < count; k += stride) {
            look_at(texelFetch(rim, k).x);
            sum += tip_force(at(positions, id).xyz, i);
        }
        impulses[pushes_given + i * stride + first].xyz += seconds * sum;
    }
    if (RESISTANCE) add_resistance(first, stride);
}
