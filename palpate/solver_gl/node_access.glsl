// node_access.glsl: what node.inl asks of a backend, for a node in the GPU's memory. After pass.inl.

layout(std140, binding = pass_block) uniform Uniforms { Pass pass; };

layout(binding = positions_unit) uniform Floats positions;   // m; w: 1/kg, below 0 where there is no node
layout(binding = velocities_unit) uniform Floats velocities;  // m/s; w: number of a guide, below 0 for none
layout(binding = traits_unit) uniform usamplerBuffer traits;   // of a slot: two words of shares; area and cover, as floats' bits
layout(binding = ties_unit) uniform samplerBuffer ties;      // of springs written out: to whom, share, stiffness, rest; behind them hinges and cells; or strengths
layout(binding = guides_unit) uniform samplerBuffer guides;    // of nodes of infinite mass, in pairs: velocity; where to, w: 1 if anywhere
layout(binding = distances_unit) uniform samplerBuffer distances; // of fields, one after the other
layout(binding = tips_unit) uniform samplerBuffer tips;        // in threes: as a RoundTip
layout(binding = push_of_unit) uniform isamplerBuffer push_of; // of a slot: the number of its push, from 1 on; 0: none
layout(binding = pushes_unit) uniform samplerBuffer pushes;    // in threes: where to, N/m; velocity, and a slot; force
layout(binding = obstacles_unit) uniform samplerBuffer obstacles; // of fields, in pairs: origin and spacing; dims and first distance; then of polygons: corners

int id;       // this node's slot
uvec4 trait;  // its own

void look_at(int slot) {
    id = slot;
    trait = texelFetch(traits, slot);
}

// A node of infinite mass moves as its guide says, from the first pass on.
#ifdef GUIDES
vec3 velocity_of(vec4 kept) { return kept.w < 0 ? kept.xyz : texelFetch(guides, 2 * int(kept.w)).xyz; }
#else
vec3 velocity_of(vec4 kept) { return kept.xyz; }
#endif

#ifdef TABLE
vec4 tie(int l) { return texelFetch(ties, l * SLOTS + id); }
int other(int l) { return floatBitsToInt(tie(l).x); }
float share(int l) { return tie(l).y; }
float stiffness(int l) { return tie(l).z; }
float tension(int l) { return tie(l).z * tie(l).w; }
float longest(int l) {
    float most = 10 * max(tie(l).w, SPACING);
    return most * most;
}
float neighbour(int l) { return other(l) != id ? 1.0 : 0.0; }
#else
int other(int l) { return id + link_offset[l]; }
#ifdef QUARTERS
float share(int l) { return 0.25 * float((l < 10 ? trait.x >> 3 * l : trait.y >> 3 * (l - 10)) & 7u); }
#else
float share(int l) { return float(trait.x >> l & 1u); }
#endif
#ifdef STRENGTH
float strength(int l) { return 0.5 * (texelFetch(ties, id).x + texelFetch(ties, other(l)).x); }
#else
float strength(int l) { return 1; }
#endif
float stiffness(int l) { return strength(l) * link_stiffness[l]; }
float tension(int l) { return strength(l) * link_tension[l]; }
float longest(int l) { return link_longest[l]; }
float neighbour(int l) { return share(l) > 0 ? 1.0 : 0.0; }
#endif

#ifdef TILE
shared vec4 tile[TILE_ROOM];  // positions of the nodes of a work group, and of those round it
int spot;                     // this node's place in it
vec3 toward(vec3 p, int l) { return tile[spot + tile_offset[l]].xyz - p; }
#else
vec3 toward(vec3 p, int l) { return at(positions, other(l)).xyz - p; }
#endif
vec3 passing(vec3 v, int l) { return velocity_of(at(velocities, other(l))) - v; }

// In pairs: the three others, and 1 for an end; stiffness, rest, area_square.
vec4 hinge_part(int h, int part) { return texelFetch(ties, (LINKS + 2 * h + part) * SLOTS + id); }
int hinge_other(int h, int n) { return floatBitsToInt(hinge_part(h, 0)[n]); }
bool hinge_end(int h) { return hinge_part(h, 0).w > 0; }
vec3 hinge_toward(vec3 p, int h, int n) { return at(positions, hinge_other(h, n)).xyz - p; }
vec3 hinge_passing(vec3 v, int h, int n) { return velocity_of(at(velocities, hinge_other(h, n))) - v; }
float hinge_stiffness(int h) { return hinge_part(h, 1).x; }
float hinge_rest(int h) { return hinge_part(h, 1).y; }
float hinge_area_square(int h) { return hinge_part(h, 1).z; }

// Behind the hinges: of each node the numbers of its eight cells from 1 on, 0 for none, in two parts; then of each cell the slots of its corners, in
// two parts, and its weight.
int cell(int k) { return floatBitsToInt(texelFetch(ties, (LINKS + 2 * HINGES + (k >> 2)) * SLOTS + id)[k & 3]) - 1; }
vec4 cell_part(int k, int part) { return texelFetch(ties, (LINKS + 2 * HINGES + 2) * SLOTS + 3 * cell(k) + part); }
int cell_slot(int k, int c) { return floatBitsToInt(cell_part(k, c >> 2)[c & 3]); }
float cell_weight(int k) { return cell(k) < 0 ? 0 : cell_part(k, 2).x; }
vec3 cell_corner(int k, int c) { return cell(k) < 0 ? vec3(0) : at(positions, cell_slot(k, c)).xyz; }
vec3 cell_corner_velocity(int k, int c) { return cell(k) < 0 ? vec3(0) : velocity_of(at(velocities, cell_slot(k, c))); }
vec3 cell_axis(int axis) { return vec3(0); }

// Cells are worked out before a pass, each once (cells.comp), and what they do to their corners lies one cell after the other.
#define OWN_CELLS
layout(binding = cell_forces_unit) uniform samplerBuffer forces_on_corners;
vec3 cells_force() {
    vec3 sum = vec3(0);
    for (int k = 0; k < CELLS; ++k)
        if (cell(k) >= 0) sum += texelFetch(forces_on_corners, 8 * cell(k) + k).xyz;
    return sum;
}

vec3 origin() { return vec3(0); }
float area() { return uintBitsToFloat(trait.z); }
float cover() { return uintBitsToFloat(trait.w); }
RoundTip tip(int i) { return RoundTip(texelFetch(tips, 3 * i), texelFetch(tips, 3 * i + 1), texelFetch(tips, 3 * i + 2)); }
void given(int i, vec3 force) {}  // touch.comp works it out
vec4 push_part(int part) {
    int number = texelFetch(push_of, id).x;
    return number > 0 ? texelFetch(pushes, 3 * (number - 1) + part) : vec4(0);
}
vec3 push() { return push_part(2).xyz; }
vec3 push_target() { return push_part(0).xyz + pass.time * push_part(1).xyz; }
float push_stiffness() { return push_part(0).w; }
vec3 corner(int i) { return texelFetch(obstacles, 2 * FIELDS + i).xyz; }

// As DistanceField::at and gradient.
float distance_at(int i, vec3 p) {
    vec4 grid = texelFetch(obstacles, 2 * i);
    ivec4 dims = floatBitsToInt(texelFetch(obstacles, 2 * i + 1));
    vec3 way = (p - grid.xyz) / grid.w, most = vec3(dims.xyz - 1);
    vec3 place = vec3(way.x > 0 ? min(way.x, most.x) : 0, way.y > 0 ? min(way.y, most.y) : 0, way.z > 0 ? min(way.z, most.z) : 0);
    ivec3 cell = min(ivec3(place), dims.xyz - 2);
    vec3 part = place - vec3(cell);
    int first = dims.w + (cell.z * dims.y + cell.y) * dims.x + cell.x;
    float sum = 0;
    for (int k = 0; k < 8; ++k) {
        ivec3 side = ivec3(k & 1, k >> 1 & 1, k >> 2);
        vec3 w = mix(1 - part, part, vec3(side));
        sum += w.x * w.y * w.z * texelFetch(distances, first + (side.z * dims.y + side.y) * dims.x + side.x).x;
    }
    return sum;
}
vec3 uphill_at(int i, vec3 p) {
    vec2 h = vec2(0.5 * texelFetch(obstacles, 2 * i).w, 0);
    return vec3(distance_at(i, p + h.xyy) - distance_at(i, p - h.xyy), distance_at(i, p + h.yxy) - distance_at(i, p - h.yxy),
                distance_at(i, p + h.yyx) - distance_at(i, p - h.yyx));
}
