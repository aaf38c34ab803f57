// A vertex on three frames, with the attributes of OnFrames. frames.comp has found the frames.

layout(location = 0) in vec3 rest_normal;
layout(location = 2) in vec3 weights;
layout(location = 3) in vec3 arms[3];
layout(location = 6) in ivec3 frames;

layout(std430, binding = 2) readonly buffer FoundFrames { mat4 found[]; };

MappedVertex follow(out vec3 normal) {
    MappedVertex f = MappedVertex(vec3(0), vec3(0), vec3(0), vec3(0));
    for (int k = 0; k < 3; ++k) {
        mat4 frame = found[frames[k]];
        f.position += weights[k] * (frame * vec4(arms[k], 1)).xyz;
        f.x += weights[k] * frame[0].xyz;
        f.y += weights[k] * frame[1].xyz;
        f.z += weights[k] * frame[2].xyz;
    }
    normal = normal_by_cofactors(f, rest_normal.x, rest_normal.y, rest_normal.z, rest_normal);
    return f;
}
