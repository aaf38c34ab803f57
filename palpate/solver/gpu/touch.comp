// touch.comp: the impulses that tips and drags give to the nodes in one pass. Each invocation adds up those of every so
// manieth slot; the host adds up the sums.

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Impulses { vec4 impulses[]; };  // N s: by tips and then drags, of each invocation
uniform float seconds;  // over which the forces act

void main() {
    int first = int(gl_GlobalInvocationID.x), stride = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    for (int i = 0; i < pass.tips + pass.drags; ++i) {
        vec3 sum = vec3(0);
        for (int slot = first; slot < SLOTS; slot += stride) {
            vec4 kept = at(positions, slot);
            if (kept.w < 0) continue;
            look_at(slot);
            sum += i < pass.tips ? tip_force(kept.xyz, i) : drag_force(kept.xyz, i - pass.tips);
        }
        impulses[i * stride + first].xyz += seconds * sum;
    }
}
