#version 450 core
// Ambient occlusion by round things, for vertex and fragment shaders.

const int most_occluders = 8;
uniform int occluders;
uniform vec3 occluder_centre[most_occluders];
uniform vec3 occluder_half[most_occluders];  // its semi-axes

// The share of the sky that a place sees past the round things near it. Each counts as an ellipsoid: in the space
// where that is a unit ball, it hides the cosine over the squared distance, but never all.
float sky_share(vec3 place, vec3 normal) {
    float share = 1;
    for (int i = 0; i < occluders; ++i) {
        vec3 towards = (occluder_centre[i] - place) / occluder_half[i];
        vec3 facing = normalize(normal * occluder_half[i]);
        float squared = max(dot(towards, towards), 1);
        share *= 1 - 0.7 * clamp(dot(facing, towards) / (squared * sqrt(squared)), 0, 1);
    }
    return share;
}
