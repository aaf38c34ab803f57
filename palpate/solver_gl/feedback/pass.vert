// pass.vert: one pass of the transform-feedback pipeline (2012, section 4). A node is a vertex; its next state is what the
// vertex shader gives out, and the rasteriser is off.

layout(location = 0) in vec4 now_position;
layout(location = 1) in vec4 now_velocity;
layout(location = 2) in vec4 start_position;
layout(location = 3) in vec4 start_velocity;
layout(location = 4) in vec4 was_position;
#ifdef SUMS
layout(location = 5) in vec4 sum_position;
layout(location = 6) in vec4 sum_velocity;
out vec4 next_sum_position, next_sum_velocity;
#endif
out vec4 next_position, next_velocity;

void main() {
    look_at(gl_VertexID);
    Kept sum = Kept(vec4(0), vec4(0));
#ifdef SUMS
    sum = Kept(sum_position, sum_velocity);
#endif
    Kept next = pass_node(Kept(now_position, now_velocity), Kept(start_position, start_velocity), was_position.xyz, sum);
    next_position = next.position;
    next_velocity = next.velocity;
#ifdef SUMS
    next_sum_position = sum.position;
    next_sum_velocity = sum.velocity;
#endif
}
