#version 450 core
// Tone mapping, from linear light to what a screen shows, with dithering.

vec3 shown(vec3 light) {
    // The usual filmic curve (ACES, in the fit by Krzysztof Narkowicz): deep shadows, and highlights that roll off
    // before they clip.
    light *= 0.8;
    vec3 tone = clamp(light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14), 0, 1);

    // Dithering by one step of the eight-bit picture, so that smooth gradients show no bands. What is stored is about
    // the square root of `tone`, so one step of it is 2 sqrt(tone) of linear light.
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    return tone + 2 * sqrt(tone) * grain / 255;
}
