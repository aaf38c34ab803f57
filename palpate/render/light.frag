#version 450 core
// The lighting model: a key light and the sky, diffuse, with specular reflection where the surface is wet.

uniform vec3 to_light;       // unit
uniform vec3 key;            // the light's colour
uniform vec3 up;             // unit

// Ambient occlusion with multiple bounces (Jimenez et al. 2016): in a groove, light bounces and takes on the albedo,
// the more so the brighter that is. `sky`: the ambient occlusion, 1 where nothing hides the sky.
vec3 bounced(float sky, vec3 albedo) {
    vec3 a = 2.0404 * albedo - 0.3324, b = -4.7951 * albedo + 0.6417, c = 2.7552 * albedo + 0.6903;
    return max(vec3(sky), ((sky * a + b) * sky + c) * sky);
}

// The specular highlight of the key light on a rough surface (GGX microfacets), for a light that a white surface
// reflects as 1.
float glint(vec3 normal, vec3 to_eye, float facing, float facing_eye, float rough) {
    float halfway = max(dot(normal, normalize(to_light + to_eye)), 0);
    float a = rough * rough, k = 0.5 * a;
    float spread = a / (halfway * halfway * (a * a - 1) + 1);
    return 0.25 * spread * spread / ((facing_eye * (1 - k) + k) * (facing * (1 - k) + k));
}

// The environment that a mirror would show: a bright ceiling above a dim floor, blurred by the roughness.
vec3 studio(vec3 direction, float rough) {
    float height = dot(direction, up);
    return mix(vec3(0.10, 0.095, 0.09), vec3(0.9, 0.95, 1.05), smoothstep(0.1 - rough, 0.5 + rough, height));
}

// The light that goes from a place to the eye. `albedo` is its colour; `sky` is its ambient occlusion, and `share`
// the share of the key light that shadows leave.
vec3 lit(vec3 normal, vec3 to_eye, vec3 albedo, float shine, float sky, float share) {
    float facing = max(dot(normal, to_light), 0);
    float facing_eye = max(dot(normal, to_eye), 1e-3);

    // Subsurface scattering: light that enters soft tissue leaves it nearby, in the colour that it absorbs least, so
    // shade begins warm.
    float direct = facing * share;
    float least = min(albedo.r, min(albedo.g, albedo.b)), most = max(albedo.r, max(albedo.g, albedo.b));
    vec3 seeping = direct * (1 + (1 - direct) * (albedo - least) / max(most, 1e-3));

    vec3 ambient = mix(vec3(0.13, 0.12, 0.115), vec3(0.46, 0.48, 0.52), 0.5 + 0.5 * dot(normal, up));
    vec3 matt = albedo * (key * seeping + ambient * bounced(sky, albedo));

    float rough = mix(0.6, 0.15, shine);
    float grazing = (1 - facing_eye) * (1 - facing_eye);
    float mirror = 0.05 + 0.6 * grazing * grazing * (1 - facing_eye);
    vec3 mirrored = key * (direct * glint(normal, to_eye, facing, facing_eye, rough)) +
                    studio(reflect(-to_eye, normal), rough) * (sky * sky);
    return matt + shine * mirror * mirrored;
}
