#version 450 core
// Takes the place of shadows.frag where nothing casts shadows.

float key_share(vec3 place, vec3 normal, float softness, int taps) { return 1; }
float soft_key_share(vec3 place, vec3 normal) { return 1; }
