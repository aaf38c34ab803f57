// bindings.inl: where shaders find what the host binds, and how many do what. C++ and GLSL read the same lines.

// Texture units.
const int positions_unit = 0, velocities_unit = 1;  // of the nodes, as they are now
const int traits_unit = 2, ties_unit = 3, guides_unit = 4, obstacles_unit = 5, distances_unit = 6;
const int cell_forces_unit = 7;
const int slots_unit = 8;
const int before_unit = 9, rim_unit = 9;  // never in one shader
const int start_positions_unit = 10, start_velocities_unit = 11, was_positions_unit = 12;
const int sum_positions_unit = 13, sum_velocities_unit = 14;
const int tips_unit = 15, push_of_unit = 16, pushes_unit = 17;
const int units = 18;

// Storage buffers.
const int next_positions_buffer = 0, next_velocities_buffer = 1;
const int next_sum_positions_buffer = 2, next_sum_velocities_buffer = 3;
const int shown_positions_buffer = 0, shown_normals_buffer = 1, findings_buffer = 2;
const int impulses_buffer = 0, cell_forces_buffer = 0;

// Uniform blocks.
const int pass_block = 0;

const int group_size = 64;  // invocations of a work group that is no tile
