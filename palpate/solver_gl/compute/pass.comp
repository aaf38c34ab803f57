// pass.comp: one pass of the compute pipeline. A node is an invocation. On a grid a work group is a box of nodes, which
// fetches each position once for all its links (TILE); else it is a row of slots.

#ifdef TILE
layout(local_size_x = TILE_X, local_size_y = TILE_Y, local_size_z = TILE_Z) in;
#else
layout(local_size_x = group_size) in;
#endif
layout(binding = start_positions_unit) uniform samplerBuffer start_positions;
layout(binding = start_velocities_unit) uniform samplerBuffer start_velocities;
layout(binding = was_positions_unit) uniform samplerBuffer was_positions;
layout(std430, binding = next_positions_buffer) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(std430, binding = next_velocities_buffer) writeonly buffer NextVelocities { vec4 next_velocities[]; };
#ifdef SUMS
layout(binding = sum_positions_unit) uniform samplerBuffer sum_positions;
layout(binding = sum_velocities_unit) uniform samplerBuffer sum_velocities;
layout(std430, binding = next_sum_positions_buffer) writeonly buffer NextSumPositions { vec4 next_sum_positions[]; };
layout(std430, binding = next_sum_velocities_buffer) writeonly buffer NextSumVelocities { vec4 next_sum_velocities[]; };
#endif

void move(int slot) {
    look_at(slot);
    Kept now = Kept(at(positions, id), at(velocities, id)), sum = Kept(vec4(0), vec4(0));
    Kept start = Kept(at(start_positions, id), at(start_velocities, id));
#ifdef SUMS
    sum = Kept(at(sum_positions, id), at(sum_velocities, id));
#endif
    Kept next = pass_node(now, start, at(was_positions, id).xyz, sum);
    next_positions[id] = next.position;
    next_velocities[id] = next.velocity;
#ifdef SUMS
    next_sum_positions[id] = sum.position;
    next_sum_velocities[id] = sum.velocity;
#endif
}

#ifdef TILE
int slot_of(ivec3 place) { return FIRST + (place.z * GRID.y + place.y) * GRID.x + place.x; }

void main() {
    ivec3 size = ivec3(gl_WorkGroupSize), wide = size + 2 * TILE_REACH, low = ivec3(gl_WorkGroupID) * size - TILE_REACH;
    for (int k = int(gl_LocalInvocationIndex); k < TILE_ROOM; k += size.x * size.y * size.z) {
        ivec3 place = low + ivec3(k % wide.x, k / wide.x % wide.y, k / (wide.x * wide.y));
        tile[k] = at(positions, slot_of(clamp(place, ivec3(0), GRID - 1)));  // beyond the grid there are no springs
    }
    barrier();
    ivec3 inside = ivec3(gl_LocalInvocationID) + TILE_REACH, here = ivec3(gl_GlobalInvocationID);
    spot = (inside.z * wide.y + inside.y) * wide.x + inside.x;
    if (all(lessThan(here, GRID))) move(slot_of(here));
}
#else
void main() {
    if (gl_GlobalInvocationID.x < SLOTS) move(int(gl_GlobalInvocationID.x));
}
#endif
