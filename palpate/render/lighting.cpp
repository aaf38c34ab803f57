#include "palpate/render/lighting.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr std::size_t most_occluders = 8;  // as in sky.glsl

}  // namespace

Lighting lighting(const Picture& picture, std::span<const Bounds> surfaces, int pixels) {
    Lighting light;
    Bounds casters;
    auto add = [&](const Bounds& box) {
        if (box.empty()) return;
        casters.include(box.low);
        casters.include(box.high);
        light.round.push_back(box);
    };
    for (const Ball& ball : picture.balls) add(bounds_of(ball));
    for (const Bounds& box : surfaces) add(box);

    const Extent extent = around(casters);
    const vec3 direction = unit(picture.light.direction, vec3(0, -1, 0));
    light.to_light = -direction;
    light.key = picture.light.colour;
    light.to_clip = light_projection(direction, extent);
    light.texel = 2 * extent.radius / static_cast<float>(pixels);
    return light;
}

void set_uniforms(const gl::Program& program, const View& view, const Lighting& light,
                  std::size_t occluders) {
    program.set("to_clip", view.to_clip);
    program.set("eye", view.eye);
    program.set("up", view.up);
    program.set("to_light", light.to_light);
    program.set("key", light.key);
    program.set("to_shadow", to_texture(light.to_clip));
    program.set("shadow_texel", light.texel);

    std::vector<vec3> centres, halves;
    for (std::size_t i = 0; i < std::min({occluders, light.round.size(), most_occluders}); ++i) {
        centres.push_back(light.round[i].centre());
        halves.push_back(glm::max(0.5f * light.round[i].size(), vec3(1e-6f)));
    }
    program.set("occluders", static_cast<int>(centres.size()));
    program.set("occluder_centre", centres);
    program.set("occluder_half", halves);
}

}  // namespace palpate
