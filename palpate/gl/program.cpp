#include "palpate/gl/program.h"

#include "palpate/base/error.h"

#include <glm/gtc/type_ptr.hpp>

#include <string>
#include <vector>

namespace palpate::gl {
namespace {

struct ShaderKind {
    static void remove(GLuint name) { glDeleteShader(name); }
};
using ShaderHandle = Handle<ShaderKind>;

// The first line of a driver's log, which says what is wrong.
std::string first_line(const std::string& log) {
    std::size_t from = log.find_first_not_of(" \t\r\n");
    if (from == std::string::npos) return "the driver gives no reason";
    return log.substr(from, log.find_first_of("\r\n", from) - from);
}

std::string compile_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string link_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

ShaderHandle compile(const Shader& shader) {
    ShaderHandle handle(glCreateShader(shader.stage));
    const GLchar* text = shader.text.data();
    const auto length = static_cast<GLint>(shader.text.size());
    glShaderSource(handle.name(), 1, &text, &length);
    glCompileShader(handle.name());
    GLint compiled = GL_FALSE;
    glGetShaderiv(handle.name(), GL_COMPILE_STATUS, &compiled);
    if (!compiled)
        throw Error("cannot compile (" + first_line(compile_log(handle.name())) + ")", shader.file,
                    "correct the shader, or update the graphics driver");
    return handle;
}

std::string names(std::initializer_list<Shader> shaders) {
    std::string all;
    for (const Shader& shader : shaders) all += (all.empty() ? "" : " with ") + std::string(shader.file);
    return all;
}

}  // namespace

Program::Program(std::initializer_list<Shader> shaders, std::span<const char* const> captured) {
    std::vector<ShaderHandle> compiled;
    for (const Shader& shader : shaders) compiled.push_back(compile(shader));
    for (const ShaderHandle& shader : compiled) glAttachShader(name(), shader.name());
    if (!captured.empty())
        glTransformFeedbackVaryings(name(), GLsizei(captured.size()), captured.data(), GL_SEPARATE_ATTRIBS);
    glLinkProgram(name());
    for (const ShaderHandle& shader : compiled) glDetachShader(name(), shader.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(name(), GL_LINK_STATUS, &linked);
    if (!linked)
        throw Error("cannot link (" + first_line(link_log(name())) + ")", names(shaders),
                    "correct the shaders, or update the graphics driver");
}

void Program::set(const char* uniform, int value) const {
    glProgramUniform1i(name(), location(uniform), value);
}

void Program::set(const char* uniform, float value) const {
    glProgramUniform1f(name(), location(uniform), value);
}

void Program::set(const char* uniform, vec2 value) const {
    glProgramUniform2fv(name(), location(uniform), 1, glm::value_ptr(value));
}

void Program::set(const char* uniform, vec3 value) const {
    glProgramUniform3fv(name(), location(uniform), 1, glm::value_ptr(value));
}

void Program::set(const char* uniform, vec4 value) const {
    glProgramUniform4fv(name(), location(uniform), 1, glm::value_ptr(value));
}

void Program::set(const char* uniform, const mat4& value) const {
    glProgramUniformMatrix4fv(name(), location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}

void Program::set(const char* uniform, std::span<const vec3> values) const {
    if (values.empty()) return;
    glProgramUniform3fv(name(), location(uniform), static_cast<GLsizei>(values.size()),
                        glm::value_ptr(values.front()));
}

}  // namespace palpate::gl
