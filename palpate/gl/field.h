#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/texture.h"

#include <cstddef>
#include <optional>
#include <span>

namespace palpate::gl {

class Context;

/// Values for many slots that shaders look up by number: a buffer, seen through a buffer texture, or laid
/// flat in a texture of rows of `width`. Move-only.
class Field {
 public:
    /// `format` is a sized one whose values take `bytes` each. `width`: a power of two, or 0 for a buffer.
    /// Filled from `values`, the rest with zeros. Throws Error if the driver has no room for so many.
    Field(GLenum format, std::size_t bytes, std::size_t slots, int width, Bytes values = {});

    /// Replaces the first values. Throws Error if there are more than slots; so do the next two.
    void put(Bytes values);
    /// Takes what another field of the same kind and size holds; nothing goes through the host.
    void copy(const Field& from);
    /// The first values, read back.
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
