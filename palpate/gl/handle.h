#pragma once
#include <epoxy/gl.h>

#include <utility>

namespace palpate::gl {

/// Owns an OpenGL object by its name. Move-only; 0 after a move. The context that made the object must be
/// current when the handle is destroyed.
template <class Kind>
class Handle {
 public:
    Handle() : name_(Kind::create()) {}
    explicit Handle(GLuint name) : name_(name) {}
    ~Handle() {
        if (name_ != 0) Kind::remove(name_);
    }
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }

    GLuint name() const { return name_; }

 private:
    GLuint name_;
};

struct VertexArrayKind {
    static GLuint create() {
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        return name;
    }
    static void remove(GLuint name) { glDeleteVertexArrays(1, &name); }
};

struct FramebufferKind {
    static GLuint create() {
        GLuint name = 0;
        glCreateFramebuffers(1, &name);
        return name;
    }
    static void remove(GLuint name) { glDeleteFramebuffers(1, &name); }
};

struct SamplerKind {
    static GLuint create() {
        GLuint name = 0;
        glCreateSamplers(1, &name);
        return name;
    }
    static void remove(GLuint name) { glDeleteSamplers(1, &name); }
};

using VertexArray = Handle<VertexArrayKind>;
using Framebuffer = Handle<FramebufferKind>;
using Sampler = Handle<SamplerKind>;

}  // namespace palpate::gl
