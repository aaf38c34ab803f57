// The deformation gradient at each frame, and the position of its node: what find_frames does in deform.cpp.

layout(local_size_x = 64) in;

// In the memory layout of Frame, Spoke and Framed::faces.
struct Frame {
    int node;
    int spokes_end, faces_end;
    float normal_pull[3];
    float rest[9];
};
struct Spoke {
    int to;
    float pull[3];
};
layout(std430, binding = 2) writeonly buffer FoundFrames { mat4 found[]; };
layout(std430, binding = 3) readonly buffer Frames { Frame frames[]; };
layout(std430, binding = 4) readonly buffer Spokes { Spoke spokes[]; };
layout(std430, binding = 5) readonly buffer Faces { int corners[]; };  // three a face

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= frames.length()) return;
    int node = frames[i].node;
    int spoke = i > 0 ? frames[i - 1].spokes_end : 0, face = i > 0 ? frames[i - 1].faces_end : 0;
    float rest[9] = frames[i].rest, normal_pull[3] = frames[i].normal_pull;
    vec3 here = node_position(node);
    mat3 gradient = mat3(rest[0], rest[1], rest[2], rest[3], rest[4], rest[5], rest[6], rest[7], rest[8]);
    for (; spoke < frames[i].spokes_end; ++spoke) {
        float pull[3] = spokes[spoke].pull;
        gradient += outerProduct(node_position(spokes[spoke].to) - here, vec3(pull[0], pull[1], pull[2]));
    }
    vec3 normals = vec3(0);  // of the faces around the node, weighted by area
    for (; face < frames[i].faces_end; ++face) {
        vec3 a = node_position(corners[3 * face]);
        normals += cross(node_position(corners[3 * face + 1]) - a, node_position(corners[3 * face + 2]) - a);
    }
    gradient += outerProduct(direction(normals, vec3(0)), vec3(normal_pull[0], normal_pull[1], normal_pull[2]));
    found[i] = mat4(vec4(gradient[0], 0), vec4(gradient[1], 0), vec4(gradient[2], 0), vec4(here, 1));
}
