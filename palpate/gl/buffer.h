#pragma once
#include "palpate/gl/handle.h"

#include <cstddef>
#include <ranges>
#include <span>

namespace palpate::gl {

struct BufferKind {
    static GLuint create() {
        GLuint name = 0;
        glCreateBuffers(1, &name);
        return name;
    }
    static void remove(GLuint name) { glDeleteBuffers(1, &name); }
};

using Bytes = std::span<const std::byte>;

/// A buffer in the GPU's memory. Move-only; its context must be current whenever it is used and when it is
/// destroyed.
class Buffer {
 public:
    /// Empty until upload().
    Buffer() = default;

    /// With immutable storage: filled here and never again by the host, though shaders may write to it.
    template <std::ranges::contiguous_range Values>
    explicit Buffer(const Values& values) : Buffer(Bytes(std::as_bytes(std::span(values)))) {}
    explicit Buffer(Bytes bytes);

    /// Room for shaders to write to; zeros at first.
    static Buffer room(std::size_t bytes);

    /// Replaces the contents, of any length. Draw calls already made still use the old ones. Not for a buffer
    /// that the constructor filled.
    template <std::ranges::contiguous_range Values>
    void upload(const Values& values) {
        upload(Bytes(std::as_bytes(std::span(values))));
    }
    void upload(Bytes bytes);

    GLuint name() const { return handle_.name(); }

 private:
    Handle<BufferKind> handle_;
    bool fixed_ = false;
};

}  // namespace palpate::gl
