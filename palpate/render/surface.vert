// A corner of a surface or of a ball. What it is linked with says where that is. If it has dents, their text stands before
// this one, with DENTS defined; and TURNED_HERE, if their normals are turned here and not in surface.frag. IMAGES is defined
// if surface.frag has to know how images lie on it.

layout(location = 8) in float openness;
#ifdef IMAGES
layout(location = 9) in vec2 texture_place;
#endif

uniform mat4 to_clip;

out vec3 place;
out vec3 facing;    // not turned by dents yet, unless TURNED_HERE
#ifdef DENTS
out vec3 undented;  // where the place would be without them
#endif
#ifdef IMAGES
out vec4 along_u;
out vec2 uv;
#endif
out float sky;  // the share of it that the place sees

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
    // What the surface at rest leaves of the sky, with more contrast than nature's so that grooves read as
    // grooves, and what the tools leave of that. It is smooth, so that once a vertex is enough.
    sky = openness * openness * sky_share(place, normal);
    gl_Position = to_clip * vec4(place, 1);
}
