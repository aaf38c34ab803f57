// cells.comp: what each cell of tissue does to its eight corners. An invocation is a node, and works out the cell of which
// that is the lowest corner.

layout(local_size_x = group_size) in;
layout(std430, binding = cell_forces_buffer) writeonly buffer CellForces { vec4 forces[]; };  // N, eight a cell

void main() {
    if (gl_GlobalInvocationID.x >= SLOTS) return;
    look_at(int(gl_GlobalInvocationID.x));
    if (cell(0) < 0) return;
    Eight force = on_corners(damped_cell_forces(0));
    for (int k = 0; k < 8; ++k) forces[8 * cell(0) + k] = vec4(force.c[k], 0);
}
