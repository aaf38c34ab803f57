// A vertex of anything, for shadow maps. With dents, their GLSL comes before this text and DENTS is defined.

uniform mat4 to_clip;

void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent);

void main() {
    vec3 place, normal;
    vec4 tangent;
    map_vertex(place, normal, tangent);
#ifdef DENTS
    place = dented(place, normal);
#endif
    gl_Position = to_clip * vec4(place, 1);
}
