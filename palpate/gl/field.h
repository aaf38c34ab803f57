#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/texture.h"

#include <cstddef>
#include <optional>
#include <span>

namespace palpate::gl {

class Context;

/// An array that shaders read by index: a buffer with a buffer texture, or a 2D texture with rows of `width`
/// texels. Move-only.
class Field {
 public:
    /// `format`: a sized internal format, of `bytes` per value. `width`: a power of two, or 0 for a buffer.
    /// Filled from `values`, the rest with zeros. Throws Error if the driver's limits are too small.
    Field(GLenum format, std::size_t bytes, std::size_t slots, int width, Bytes values = {});

    /// Replaces the first values. Throws Error if there are more values than slots; so do the next two.
    void put(Bytes values);
    /// Copies another field of the same format and size, on the GPU.
    void copy(const Field& from);
    /// Reads back the first values.
    void get(const Context& context, std::span<std::byte> to) const;

    void bind(GLuint unit) const { glBindTextureUnit(unit, texture()); }

    GLuint texture() const { return flat_ ? flat_->name() : view_.name(); }
    GLuint buffer() const { return buffer_ ? buffer_->name() : 0; }
    int width() const { return flat_ ? flat_->width() : 0; }
    int height() const { return flat_ ? flat_->height() : 0; }
    std::size_t bytes() const { return bytes_ * slots_; }

 private:
    void check_fits(std::size_t bytes_at_hand) const;

    GLenum format_;
    std::size_t bytes_, slots_;
    std::optional<Buffer> buffer_;
    Handle<TextureKind> view_{0u};
    std::optional<Texture> flat_;
};

}  // namespace palpate::gl
