#version 450 core
// How a place on anything is lit: by a key light and by the sky, with glints where it is wet.

uniform vec3 to_light;       // unit
uniform vec3 key;            // the light's colour
uniform vec3 up;             // unit

// The share of the sky's light that a groove with some share of the sky gives back: in it, light bounces and
// takes on the thing's colour, the more the brighter that is (Jimenez et al. 2016, multiple bounces).
vec3 bounced(float sky, vec3 look) {
    vec3 a = 2.0404 * look - 0.3324, b = -4.7951 * look + 0.6417, c = 2.7552 * look + 0.6903;
    return max(vec3(sky), ((sky * a + b) * sky + c) * sky);
}

// A lamp's glint on a rough surface (GGX), for a lamp that a white surface reflects as 1.
float glint(vec3 normal, vec3 to_eye, float facing, float facing_eye, float rough) {
    float halfway = max(dot(normal, normalize(to_light + to_eye)), 0);
    float a = rough * rough, k = 0.5 * a;
    float spread = a / (halfway * halfway * (a * a - 1) + 1);
    return 0.25 * spread * spread / ((facing_eye * (1 - k) + k) * (facing * (1 - k) + k));
}

// What a mirror would show: a bright ceiling above a dim floor, blurred by the roughness.
vec3 studio(vec3 direction, float rough) {
    float height = dot(direction, up);
    return mix(vec3(0.10, 0.095, 0.09), vec3(0.9, 0.95, 1.05), smoothstep(0.1 - rough, 0.5 + rough, height));
}

// Light that leaves a place for the eye. `look` is its colour, `sky` and `share` are the shares of the sky and of
// the key light that get there.
vec3 lit(vec3 normal, vec3 to_eye, vec3 look, float shine, float sky, float share) {
    float facing = max(dot(normal, to_light), 0);
    float facing_eye = max(dot(normal, to_eye), 1e-3);

    // Light that enters soft tissue leaves it nearby in the colour that it absorbs least: shade begins warm.
    float direct = facing * share;
    float least = min(look.r, min(look.g, look.b)), most = max(look.r, max(look.g, look.b));
    vec3 seeping = direct * (1 + (1 - direct) * (look - least) / max(most, 1e-3));

    vec3 ambient = mix(vec3(0.13, 0.12, 0.115), vec3(0.46, 0.48, 0.52), 0.5 + 0.5 * dot(normal, up));
    vec3 matt = look * (key * seeping + ambient * bounced(sky, look));

    float rough = mix(0.6, 0.15, shine);
    float grazing = (1 - facing_eye) * (1 - facing_eye);
    float mirror = 0.05 + 0.6 * grazing * grazing * (1 - facing_eye);
    vec3 mirrored = key * (direct * glint(normal, to_eye, facing, facing_eye, rough)) +
                    studio(reflect(-to_eye, normal), rough) * (sky * sky);
    return matt + shine * mirror * mirrored;
}
