// pass.frag: one pass over nodes laid flat in textures (2005, section 3.1; the implicit connections of the papers it cites).
// A node is a fragment, its slot the place of that in the texture; its neighbours are as many slots away for all.

layout(binding = start_positions_unit) uniform sampler2D start_positions;
layout(binding = start_velocities_unit) uniform sampler2D start_velocities;
layout(binding = was_positions_unit) uniform sampler2D was_positions;
layout(location = 0) out vec4 next_position;
layout(location = 1) out vec4 next_velocity;
#ifdef SUMS
layout(binding = sum_positions_unit) uniform sampler2D sum_positions;
layout(binding = sum_velocities_unit) uniform sampler2D sum_velocities;
layout(location = 2) out vec4 next_sum_position;
layout(location = 3) out vec4 next_sum_velocity;
#endif

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    look_at(min(place.y * FLAT + place.x, SLOTS - 1));
    Kept now = Kept(at(positions, id), at(velocities, id)), sum = Kept(vec4(0), vec4(0));
    Kept start = Kept(at(start_positions, id), at(start_velocities, id));
#ifdef SUMS
    sum = Kept(at(sum_positions, id), at(sum_velocities, id));
#endif
    Kept next = pass_node(now, start, at(was_positions, id).xyz, sum);
    next_position = next.position;
    next_velocity = next.velocity;
#ifdef SUMS
    next_sum_position = sum.position;
    next_sum_velocity = sum.velocity;
#endif
}
