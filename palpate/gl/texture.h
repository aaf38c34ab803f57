#pragma once
#include "palpate/gl/handle.h"

#include <cstdint>

namespace palpate::gl {

struct TextureKind {
    static void remove(GLuint name) { glDeleteTextures(1, &name); }
};

/// A 2D texture. Move-only; its context must be current whenever it is used and when it is destroyed.
class Texture {
 public:
    /// `format`: a sized internal format, such as GL_RGBA8. With more than one sample a pixel, shaders cannot
    /// filter it.
    Texture(GLenum format, int width, int height, int samples = 1);

    /// Filled, with mipmaps. `pixels`: width × height times four bytes, the lowest row first.
    static Texture with_mipmaps(GLenum format, int width, int height, const std::uint8_t* pixels);

    GLuint name() const { return handle_.name(); }
    int width() const { return width_; }
    int height() const { return height_; }

 private:
    Texture(Handle<TextureKind> handle, int width, int height)
        : handle_(std::move(handle)), width_(width), height_(height) {}
    Handle<TextureKind> handle_;
    int width_;
    int height_;
};

}  // namespace palpate::gl
