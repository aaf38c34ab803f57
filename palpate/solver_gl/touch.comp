// touch.comp: the impulses that tips and drags give to the nodes in one pass. Each invocation adds up those that a tip
// gives to every so manieth node of the outside, which alone it touches; the host adds up the sums.

layout(local_size_x = group_size) in;
layout(binding = rim_unit) uniform isamplerBuffer rim;  // the slots of the nodes of the outside
layout(std430, binding = impulses_buffer) buffer Impulses { vec4 impulses[]; };  // N s: by tips and then drags, of each invocation
uniform int count;      // of the nodes of the outside
uniform float seconds;  // over which the forces act

void main() {
    int first = int(gl_GlobalInvocationID.x), stride = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    for (int i = 0; i < TIPS; ++i) {
        vec3 sum = vec3(0);
        for (int k = first; k < count; k += stride) {
            look_at(texelFetch(rim, k).x);
            sum += tip_force(at(positions, id).xyz, i);
        }
        impulses[i * stride + first].xyz += seconds * sum;
    }
    if (first >= DRAGS) return;
    look_at(pass.dragged[first / 4][first % 4]);
    impulses[(TIPS + first) * stride + first].xyz += seconds * drag_force(at(positions, id).xyz, first);
}
