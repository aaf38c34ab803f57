#pragma once
#include "palpate/body/dent.h"
#include "palpate/gl/buffer.h"

#include <string>

namespace palpate {

/// The dents of one surface in the memory of a GPU, and the GLSL that shows them: what dented() and
/// dented_normal() do on the host. For our shaders and for those of other OpenGL applications. Move-only; its
/// context (4.5 core) must be current whenever it is used, and when it ends. With that context current, an
/// application
///
/// 1. puts shader() after the #version line of its vertex and of its fragment shader, and calls in the one
///        position = dented(position, normal);
///    and in the other, with the place that was not moved and its normal (unit), interpolated,
///        normal = dented_normal(place, normal);
/// 2. makes one of these for each surface, and before drawing that calls set(), if anything moved, and
/// bind().
///
/// Places, centres, depths and widths are in one space, which the application may choose if it differs from
/// the world by a rigid motion only. The names of dent.glsl and dent.inl are taken in those shaders.
class GpuDents {
 public:
    /// Without any dents.
    GpuDents() { set({}); }

    /// Sets those of `dents` that act; if there are more than most_dents, the first of them.
    void set(std::span<const Dent> dents);

    /// How many there are.
    int count() const { return count_; }

    /// What is drawn next has these dents, if its shaders were made for the same `binding` of uniform
    /// buffers.
    void bind(GLuint binding = 0) const { glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer_.name()); }

    /// The GLSL of dented() and dented_normal(), without a #version line: that must be 450 core.
    static std::string shader(GLuint binding = 0);

 private:
    gl::Buffer buffer_;
    int count_ = 0;
};

}  // namespace palpate
