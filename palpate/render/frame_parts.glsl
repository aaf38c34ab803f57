// A part of a cluster, as FramePart in culling.cpp: its vertices on the same three frames, the range of their second
// and third weight, and for each frame the bounding box of their arms.

struct Part {
    int frames[3];
    float low[2], high[2];
    float arm[9], spread[9];  // the centres of the three boxes, and half their sizes
};
layout(std430, binding = 3) readonly buffer Parts { Part parts[]; };
layout(std430, binding = 2) readonly buffer FoundFrames { mat4 found[]; };

void include_part(int i, inout Box box) {
    // Where each frame carries the centre of its box, and how far from there the rest of the box reaches.
    vec3 carried[3], beside[3];
    for (int k = 0; k < 3; ++k) {
        mat4 frame = found[parts[i].frames[k]];
        int x = 3 * k, y = x + 1, z = x + 2;
        carried[k] = (frame * vec4(parts[i].arm[x], parts[i].arm[y], parts[i].arm[z], 1)).xyz;
        beside[k] = parts[i].spread[x] * abs(frame[0].xyz) + parts[i].spread[y] * abs(frame[1].xyz) +
                    parts[i].spread[z] * abs(frame[2].xyz);
    }
    for (int k = 0; k < 4; ++k) {
        float y = (k & 1) == 0 ? parts[i].low[0] : parts[i].high[0];
        float z = (k & 2) == 0 ? parts[i].low[1] : parts[i].high[1];
        vec3 place = carried[0] + y * (carried[1] - carried[0]) + z * (carried[2] - carried[0]);
        vec3 reach = abs(1 - y - z) * beside[0] + abs(y) * beside[1] + abs(z) * beside[2];
        include(box, place - reach);
        include(box, place + reach);
    }
}

// Unknown, as each frame turns by itself.
bool faces_away(Cluster c, int first, int end, Box box) { return false; }
