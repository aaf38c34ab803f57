#pragma once
#include "palpate/gl/context.h"
#include "palpate/gl/texture.h"
#include "palpate/mesh/image.h"

namespace palpate {

/// Throws Error if the driver has no images of that size, in pixels.
void check_size(int width, int height);

/// An image in the GPU's memory to draw into, with four samples a pixel for smooth edges. Light in it is
/// linear; the GPU turns it into sRGB where it stores it.
class Target {
 public:
    /// In pixels. Throws Error if the driver has no images of that size.
    Target(int width, int height);

    /// Clears it and makes it what is drawn into.
    void begin() const;

    /// Averages the samples of each pixel.
    void end() const;

    /// What was drawn before the last end().
    Image read(const gl::Context& context) const;

    int width() const { return pixels_.width(); }
    int height() const { return pixels_.height(); }
    float aspect() const { return static_cast<float>(width()) / static_cast<float>(height()); }

 private:
    gl::Texture samples_, depth_, pixels_;
    gl::Framebuffer drawn_, shown_;
};

}  // namespace palpate
