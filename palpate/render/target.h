#pragma once
#include "palpate/base/vectors.h"
#include "palpate/gl/context.h"
#include "palpate/gl/texture.h"
#include "palpate/mesh/image.h"

#include <optional>

namespace palpate {

/// Throws Error if the driver has no images of that size, in pixels.
void check_size(int width, int height);

/// An image in the GPU's memory to draw into, with several samples a pixel for smooth edges (multisampling).
/// Shaders write linear light; the GPU encodes it as sRGB.
class Target {
 public:
    /// In pixels. Throws Error if the driver has no images of that size. If it does not offer that many
    /// samples, it takes as many as there are.
    Target(int width, int height, int samples);

    /// Clears it and binds it for drawing.
    void begin() const;

    /// Averages the samples of each pixel.
    void end() const;

    /// What was drawn before the last end().
    Image read(const gl::Context& context) const;

    /// Copies that, byte for byte, into the framebuffer that is bound for drawing, stretched from the corner
    /// `low` to `high`. GL_FRAMEBUFFER_SRGB and the scissor must be off, as during a gl::Visit.
    void show(ivec2 low, ivec2 high) const;

    int width() const { return pixels_.width(); }
    int height() const { return pixels_.height(); }

 private:
    gl::Texture pixels_, depth_;
    std::optional<gl::Texture> samples_;  // if there is more than one a pixel
    gl::Framebuffer drawn_, shown_;
};

}  // namespace palpate
