// A surface or a ball. If it has dents and their normals are turned here, their text stands before this one, with DENTS
// defined; and IMAGES, if it may not be of one colour and as smooth as its vertices say all over.

in vec3 place;
in vec3 facing;
#ifdef DENTS
in vec3 undented;  // where the place would be without dents, with the normal `facing`
#endif
in float sky;  // the share of it that the place sees

uniform vec4 eye;  // see View
uniform vec3 to_light;
uniform vec3 look;
uniform float shine;

out vec4 colour;

vec3 lit(vec3 normal, vec3 to_eye, vec3 look, float shine, float sky, float share);
float key_share(vec3 place, vec3 normal, float softness, int taps);
vec3 shown(vec3 light);

#ifdef IMAGES
in vec4 along_u;  // the tangent, and whether v runs along the normal × it, 1, or against, -1
in vec2 uv;

layout(binding = 4) uniform sampler2D colour_map;
layout(binding = 5) uniform sampler2D normal_map;

uniform bool coloured;       // whether there is a colour map,
uniform bool bumpy;          // and a normal map
uniform bool shows_normals;  // see Look

// What the normal map says, about a normal on the front side.
vec3 bumped(vec3 normal) {
    if (!bumpy) return normal;
    vec3 tangent = along_u.xyz - dot(along_u.xyz, normal) * normal;
    if (!(dot(tangent, tangent) > 1e-8)) return normal;
    tangent = normalize(tangent);
    vec3 across = sign(along_u.w) * cross(normal, tangent);
    vec3 bump = (texture(normal_map, uv).xyz * 255 - 128) / 127;
    return normalize(bump.x * tangent + bump.y * across + max(bump.z, 0.05) * normal);
}

vec3 own_colour(vec3 smooth_normal) {
    if (shows_normals) return pow(max(0.5 + 0.5 * smooth_normal, 0), vec3(2.2));  // so that the screen shows them evenly
    return coloured ? look * texture(colour_map, uv).rgb : look;
}
#else
vec3 bumped(vec3 normal) { return normal; }
vec3 own_colour(vec3 normal) { return look; }
#endif

void main() {
    vec3 to_eye = normalize(eye.xyz - eye.w * place);
    vec3 smooth_normal = dot(facing, facing) > 0 ? normalize(facing) : gl_FrontFacing ? to_eye : -to_eye;
#ifdef DENTS
    smooth_normal = dented_normal(undented, smooth_normal);
#endif
    vec3 normal = bumped(smooth_normal);
    if (!gl_FrontFacing) normal = -normal;
    float share = dot(normal, to_light) > 0 ? key_share(place, normal, 2.5, 10) : 0;
    colour = vec4(shown(lit(normal, to_eye, own_colour(smooth_normal), shine, sky, share)), 1);
}
