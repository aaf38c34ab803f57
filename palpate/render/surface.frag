// A surface or a ball. With dents that turn normals here, their GLSL comes before this text and DENTS is defined.
// IMAGES is defined if it may have a colour map or a normal map, or shows its normals as colours.

in vec3 place;
in vec3 facing;
#ifdef DENTS
in vec3 undented;  // the position before the dents, whose normal is `facing`
#endif
in float sky;  // ambient occlusion: the share of the sky that the place sees

uniform vec4 eye;  // see View
uniform vec3 to_light;
uniform vec3 albedo;
uniform float shine;

out vec4 colour;

vec3 lit(vec3 normal, vec3 to_eye, vec3 albedo, float shine, float sky, float share);
float key_share(vec3 place, vec3 normal, float softness, int taps);
vec3 shown(vec3 light);

#ifdef IMAGES
in vec4 along_u;  // the tangent; w is the sign of the bitangent: 1 if v runs along normal × tangent, -1 if against it
in vec2 uv;

layout(binding = 4) uniform sampler2D colour_map;
layout(binding = 5) uniform sampler2D normal_map;

uniform bool coloured;       // whether there is a colour map,
uniform bool bumpy;          // and a normal map
uniform bool shows_normals;  // see Look

// Normal mapping: `normal` turned by the normal map, on the front side.
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
    if (shows_normals) return pow(max(0.5 + 0.5 * smooth_normal, 0), vec3(2.2));  // undoes the screen's gamma
    return coloured ? albedo * texture(colour_map, uv).rgb : albedo;
}
#else
vec3 bumped(vec3 normal) { return normal; }
vec3 own_colour(vec3 normal) { return albedo; }
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
