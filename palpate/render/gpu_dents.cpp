#include "palpate/render/gpu_dents.h"

#include "palpate/render/macros.h"

#include <array>

namespace palpate {
namespace {

const char* dent_glsl =
#include "embedded/dent.glsl.h"
    ;
const char* dent_inl =
#include "embedded/dent.inl.h"
    ;

// The block of dent.glsl in its std140 layout.
struct Placed {
    vec3 centre;
    float depth;
    vec3 facing;
    float width;
};
struct Block {
    std::array<Placed, most_dents> dents = {};
    int count = 0;
};
static_assert(sizeof(Placed) == 32);

}  // namespace

void GpuDents::set(std::span<const Dent> dents) {
    Block block;
    for (const Dent& dent : dents)
        if (acts(dent) && block.count < most_dents)
            block.dents[std::size_t(block.count++)] = {dent.centre, dent.depth, dent.facing, dent.width};
    count_ = block.count;
    buffer_.upload(std::span(&block, 1));
}

std::string GpuDents::shader(GLuint binding) {
    return "#define MOST_DENTS " + std::to_string(most_dents) + "\n#define DENTS " + std::to_string(binding) +
           "\n" + dent_glsl + macros_glsl + dent_inl + macros_end_glsl;
}

}  // namespace palpate
