#pragma once
#include "palpate/base/vectors.h"
#include "palpate/gl/handle.h"

#include <initializer_list>
#include <span>
#include <string_view>

namespace palpate::gl {

/// The source of one shader.
struct Shader {
    GLenum stage;           // GL_VERTEX_SHADER, ...
    std::string_view file;  // its name, for errors
    std::string_view text;
};

struct ProgramKind {
    static GLuint create() { return glCreateProgram(); }
    static void remove(GLuint name) { glDeleteProgram(name); }
};

/// A linked shader program. Move-only; its context must be current whenever it is used and when it is
/// destroyed.
class Program {
 public:
    /// Several shaders of one stage may be linked together: functions that one declares, another defines.
    /// Throws Error with the file's name and the first line of the driver's log. `captured`: outputs of the
    /// vertex shader that transform feedback writes, each into a buffer of its own.
    explicit Program(std::initializer_list<Shader> shaders, std::span<const char* const> captured = {});

    void use() const { glUseProgram(handle_.name()); }

    /// Sets a uniform; the program need not be in use. A name that the shaders do not use is ignored, so
    /// several programs can be given the same uniforms.
    void set(const char* name, int value) const;
    void set(const char* name, float value) const;
    void set(const char* name, vec2 value) const;
    void set(const char* name, vec3 value) const;
    void set(const char* name, vec4 value) const;
    void set(const char* name, const mat4& value) const;
    void set(const char* name, std::span<const vec3> values) const;

    GLuint name() const { return handle_.name(); }

 private:
    GLint location(const char* uniform) const { return glGetUniformLocation(name(), uniform); }
    Handle<ProgramKind> handle_;
};

}  // namespace palpate::gl
