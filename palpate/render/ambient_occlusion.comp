#version 450 core
// Ambient occlusion: adds to each vertex the share of the sky that one parallel light stands for, if it is not in its
// shadow.

layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Normals { float normals[]; };
layout(std430, binding = 2) buffer AmbientOcclusion { float ambient_occlusion[]; };
layout(binding = 0) uniform sampler2DShadow shadow;

uniform mat4 to_shadow;  // from the world to the map, 0 to 1 in each direction
uniform vec3 to_light;
uniform float lift;   // m; how far above the surface to look up the shadow map, so that it does not shadow itself
uniform float share;  // what a light adds that shines along the normal

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ambient_occlusion.length()) return;
    vec3 place = vec3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    vec3 normal = vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    float facing = dot(normal, to_light);
    if (!(facing > 0)) return;
    vec3 seen = (to_shadow * vec4(place + lift * normal, 1)).xyz;
    ambient_occlusion[i] += share * facing * texture(shadow, seen);
}
