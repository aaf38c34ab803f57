#version 450 core
// How much of the sky round things hide. For vertices and for fragments.

const int most_occluders = 8;
uniform int occluders;
uniform vec3 occluder_centre[most_occluders];
uniform vec3 occluder_half[most_occluders];  // half its length along each axis

// The share of the sky that the round things near a place leave to it. Each counts as an ellipsoid: in the
// space where that is a unit ball, it hides the cosine over the squared distance, but never all.
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
