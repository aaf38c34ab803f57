// pass.comp: one pass of the compute pipeline. A node is an invocation.

layout(local_size_x = 64) in;
layout(binding = 10) uniform samplerBuffer start_positions;
layout(binding = 11) uniform samplerBuffer start_velocities;
layout(binding = 12) uniform samplerBuffer was_positions;
layout(std430, binding = 0) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(std430, binding = 1) writeonly buffer NextVelocities { vec4 next_velocities[]; };
#ifdef SUMS
layout(binding = 13) uniform samplerBuffer sum_positions;
layout(binding = 14) uniform samplerBuffer sum_velocities;
layout(std430, binding = 2) writeonly buffer NextSumPositions { vec4 next_sum_positions[]; };
layout(std430, binding = 3) writeonly buffer NextSumVelocities { vec4 next_sum_velocities[]; };
#endif

void main() {
    if (gl_GlobalInvocationID.x >= SLOTS) return;
    look_at(int(gl_GlobalInvocationID.x));
    Kept now = Kept(at(positions, id), at(velocities, id)), sum = Kept(vec4(0), vec4(0));
    Kept start = Kept(at(start_positions, id), at(start_velocities, id));
#ifdef SUMS
    sum = Kept(at(sum_positions, id), at(sum_velocities, id));
#endif
    Kept next = turn(now, start, at(was_positions, id).xyz, sum);
    next_positions[id] = next.position;
    next_velocities[id] = next.velocity;
#ifdef SUMS
    next_sum_positions[id] = sum.position;
    next_sum_velocities[id] = sum.velocity;
#endif
}
