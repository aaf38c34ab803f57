#version 450 core
// A line of a wireframe, drawn as a strip of two triangles so that it is `width` pixels wide on every driver.

layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer Lines { uint lines[]; };

uniform mat4 to_clip;
uniform vec4 eye;      // see View
uniform float lift;    // m; how far towards the eye a line is moved, so that the surface on which it lies does not
                       // hide it
uniform vec3 middle;   // m; the centre of the bounding sphere of all things,
uniform float radius;  // m; and its radius
uniform vec2 picture;  // pixels
uniform float width;   // pixels

out float nearness;  // -1 at the far side of the things, 1 at the near one

vec3 end(int i) {
    uint p = 3 * lines[2 * gl_InstanceID + i];
    return vec3(points[p], points[p + 1], points[p + 2]);
}

vec3 to_eye(vec3 place) { return normalize(eye.xyz - eye.w * place); }

vec4 lifted(vec3 place) { return to_clip * vec4(place + lift * to_eye(place), 1); }

void main() {
    vec3 here = end(gl_VertexID & 1);
    nearness = dot(here - middle, to_eye(here)) / radius;

    vec4 from = lifted(end(0)), to = lifted(end(1));
    // Behind the near plane, a point has no place on the screen: cut there.
    float from_depth = from.z + from.w, to_depth = to.z + to.w;
    if (from_depth <= 0 && to_depth <= 0) {
        gl_Position = vec4(0, 0, -2, 1);
        return;
    }
    if (from_depth < 0 && to_depth > 0) from = mix(from, to, from_depth / (from_depth - to_depth));
    if (to_depth < 0 && from_depth > 0) to = mix(to, from, to_depth / (to_depth - from_depth));

    vec2 along = (to.xy / to.w - from.xy / from.w) * picture;
    float far = length(along);
    vec2 aside = far > 0 ? vec2(-along.y, along.x) / far : vec2(0);
    gl_Position = (gl_VertexID & 1) == 0 ? from : to;
    gl_Position.xy += (gl_VertexID < 2 ? width : -width) * aside / picture * gl_Position.w;
}
