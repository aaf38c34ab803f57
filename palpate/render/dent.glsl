// dent.glsl: the dents of a surface, for any stage of a shader. It needs two #defines before it: MOST_DENTS, how many
// there can be, and DENTS, the binding of their uniform block.

struct Dent {
    vec3 centre;
    float depth;
    vec3 facing;
    float width;
};
layout(std140, binding = DENTS) uniform Dents {
    Dent dents[MOST_DENTS];
    int dent_count;
};
Dent dent(int i) { return dents[i]; }
