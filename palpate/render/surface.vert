// A vertex of a surface or of a ball, at the position that map_vertex() gives. With dents, their GLSL comes before
// this text and DENTS is defined; TURNED_HERE too, if they turn normals here and not in surface.frag. IMAGES is
// defined if surface.frag needs texture coordinates and tangents.

layout(location = 8) in float ambient_occlusion;
#ifdef IMAGES
layout(location = 9) in vec2 texture_place;
#endif

uniform mat4 to_clip;

out vec3 place;
out vec3 facing;    // the normal, before dents turn it unless TURNED_HERE
#ifdef DENTS
out vec3 undented;  // the position before them
#endif
#ifdef IMAGES
out vec4 along_u;
out vec2 uv;
#endif
out float sky;  // ambient occlusion: the share of the sky that the place sees

void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent);
float sky_share(vec3 place, vec3 normal);

void main() {
    vec4 tangent;
    map_vertex(place, facing, tangent);
    vec3 normal = facing;
#ifdef DENTS
    undented = place;
    normal = dented_normal(place, facing);
    place = dented(place, facing);
#endif
#ifdef TURNED_HERE
    facing = normal;
#endif
#ifdef IMAGES
    along_u = tangent;
    uv = texture_place;
#endif
    // The surface's own ambient occlusion, squared to make grooves stand out, times that of the tools. It is smooth,
    // so once per vertex is enough.
    sky = ambient_occlusion * ambient_occlusion * sky_share(place, normal);
    gl_Position = to_clip * vec4(place, 1);
}
