#pragma once
#include "palpate/gl/handle.h"
#include "palpate/gl/program.h"
#include "palpate/gl/texture.h"
#include "palpate/gl/visit.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

// An application that shares its context with us, and has set everything otherwise than we need it.

namespace palpate {

/// All that OpenGL says of its state where ours might be left, by names that tests print.
inline std::map<std::string, std::vector<GLint64>> state_of_context() {
    std::map<std::string, std::vector<GLint64>> state;
    auto number = [](GLenum name) { return std::to_string(name); };
    for (GLenum name : {GL_CULL_FACE,
                        GL_DEPTH_TEST,
                        GL_STENCIL_TEST,
                        GL_FRAMEBUFFER_SRGB,
                        GL_RASTERIZER_DISCARD,
                        GL_POLYGON_OFFSET_FILL,
                        GL_POLYGON_OFFSET_LINE,
                        GL_POLYGON_OFFSET_POINT,
                        GL_POLYGON_SMOOTH,
                        GL_LINE_SMOOTH,
                        GL_COLOR_LOGIC_OP,
                        GL_DEPTH_CLAMP,
                        GL_SAMPLE_ALPHA_TO_COVERAGE,
                        GL_SAMPLE_ALPHA_TO_ONE,
                        GL_SAMPLE_COVERAGE,
                        GL_SAMPLE_MASK,
                        GL_SAMPLE_SHADING,
                        GL_PRIMITIVE_RESTART,
                        GL_PRIMITIVE_RESTART_FIXED_INDEX,
                        GL_PROGRAM_POINT_SIZE,
                        GL_MULTISAMPLE,
                        GL_DITHER,
                        GL_TEXTURE_CUBE_MAP_SEAMLESS,
                        GL_CLIP_DISTANCE0,
                        GL_CLIP_DISTANCE1,
                        GL_CLIP_DISTANCE7})
        state["switch " + number(name)] = {glIsEnabled(name)};
    for (GLenum name : {GL_DEPTH_FUNC,
                        GL_DEPTH_WRITEMASK,
                        GL_CULL_FACE_MODE,
                        GL_FRONT_FACE,
                        GL_PROVOKING_VERTEX,
                        GL_CLIP_ORIGIN,
                        GL_CLIP_DEPTH_MODE,
                        GL_LOGIC_OP_MODE,
                        GL_STENCIL_FUNC,
                        GL_STENCIL_WRITEMASK,
                        GL_ACTIVE_TEXTURE,
                        GL_CURRENT_PROGRAM,
                        GL_VERTEX_ARRAY_BINDING,
                        GL_DRAW_FRAMEBUFFER_BINDING,
                        GL_READ_FRAMEBUFFER_BINDING,
                        GL_RENDERBUFFER_BINDING,
                        GL_ARRAY_BUFFER_BINDING,
                        GL_ELEMENT_ARRAY_BUFFER_BINDING,
                        GL_COPY_READ_BUFFER_BINDING,
                        GL_COPY_WRITE_BUFFER_BINDING,
                        GL_DRAW_INDIRECT_BUFFER_BINDING,
                        GL_DISPATCH_INDIRECT_BUFFER_BINDING,
                        GL_PIXEL_PACK_BUFFER_BINDING,
                        GL_PIXEL_UNPACK_BUFFER_BINDING,
                        GL_SHADER_STORAGE_BUFFER_BINDING,
                        GL_UNIFORM_BUFFER_BINDING,
                        GL_TEXTURE_BUFFER_BINDING,
                        GL_TRANSFORM_FEEDBACK_BINDING,
                        GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
                        GL_UNPACK_SWAP_BYTES,
                        GL_UNPACK_LSB_FIRST,
                        GL_UNPACK_ROW_LENGTH,
                        GL_UNPACK_IMAGE_HEIGHT,
                        GL_UNPACK_SKIP_ROWS,
                        GL_UNPACK_SKIP_PIXELS,
                        GL_UNPACK_SKIP_IMAGES,
                        GL_UNPACK_ALIGNMENT,
                        GL_PACK_SWAP_BYTES,
                        GL_PACK_LSB_FIRST,
                        GL_PACK_ROW_LENGTH,
                        GL_PACK_IMAGE_HEIGHT,
                        GL_PACK_SKIP_ROWS,
                        GL_PACK_SKIP_PIXELS,
                        GL_PACK_SKIP_IMAGES,
                        GL_PACK_ALIGNMENT}) {
        GLint value = 0;
        glGetIntegerv(name, &value);
        state["value " + number(name)] = {value};
    }
    std::array<GLint, 2> polygons = {};
    glGetIntegerv(GL_POLYGON_MODE, polygons.data());
    state["polygons"] = {polygons[0]};
    std::array<GLfloat, 4> floats = {};
    for (GLenum name : {GL_COLOR_CLEAR_VALUE, GL_BLEND_COLOR}) {
        glGetFloatv(name, floats.data());
        for (GLfloat f : floats) state["floats " + number(name)].push_back(GLint64(1000 * f));
    }
    for (GLuint i = 0; i < 8; ++i) {
        auto& colour = state["colour " + std::to_string(i)];
        colour.push_back(glIsEnabledi(GL_BLEND, i));
        for (GLenum name : {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA,
                            GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA}) {
            GLint value = 0;
            glGetIntegeri_v(name, i, &value);
            colour.push_back(value);
        }
        std::array<GLboolean, 4> mask = {};
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
        colour.insert(colour.end(), mask.begin(), mask.end());
        for (auto [name, start, size] :
             {std::array<GLenum, 3>{GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                    GL_SHADER_STORAGE_BUFFER_SIZE},
              {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE}}) {
            auto& buffer = state["buffer " + number(name) + " " + std::to_string(i)];
            for (GLenum what : {name, start, size}) {
                GLint64 value = 0;
                glGetInteger64i_v(what, i, &value);
                buffer.push_back(value);
            }
        }
    }
    for (GLuint i = 0; i < 16; ++i) {
        auto& window = state["viewport " + std::to_string(i)];
        glGetFloati_v(GL_VIEWPORT, i, floats.data());
        for (GLfloat f : floats) window.push_back(GLint64(1000 * f));
        std::array<GLdouble, 2> range = {};
        glGetDoublei_v(GL_DEPTH_RANGE, i, range.data());
        for (GLdouble d : range) window.push_back(GLint64(1e6 * d));
        std::array<GLint, 4> box = {};
        glGetIntegeri_v(GL_SCISSOR_BOX, i, box.data());
        window.insert(window.end(), box.begin(), box.end());
        window.push_back(glIsEnabledi(GL_SCISSOR_TEST, i));
    }
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLuint unit = 0; unit < 32; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (GLenum name :
             {GL_TEXTURE_BINDING_1D, GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_3D,
              GL_TEXTURE_BINDING_CUBE_MAP, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_BUFFER,
              GL_TEXTURE_BINDING_2D_MULTISAMPLE, GL_SAMPLER_BINDING}) {
            GLint value = 0;
            glGetIntegerv(name, &value);
            state["unit " + std::to_string(unit)].push_back(value);
        }
    }
    glActiveTexture(GLenum(active));
    return state;
}

/// Has set everything otherwise, with objects of its own, until it ends.
class Hostile {
 public:
    Hostile()
        : pixels_(GL_RGBA8, 8, 8),
          program_({{GL_VERTEX_SHADER, "own.vert",
                     "#version 450 core\nvoid main() { gl_Position = vec4(0, 0, 0, 1); }\n"}}) {
        glCreateBuffers(1, &buffer_);
        glNamedBufferStorage(buffer_, 1 << 16, nullptr, GL_DYNAMIC_STORAGE_BIT);
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &view_);
        glTextureBuffer(view_, GL_R32F, buffer_);
        glCreateTransformFeedbacks(1, &captured_);
        glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, pixels_.name(), 0);
        set();
    }
    ~Hostile() {
        glDeleteBuffers(1, &buffer_);
        glDeleteTextures(1, &view_);
        glDeleteTransformFeedbacks(1, &captured_);
    }
    Hostile(const Hostile&) = delete;
    Hostile& operator=(const Hostile&) = delete;

    GLuint framebuffer() const { return framebuffer_.name(); }

 private:
    void set() const {
        for (GLenum on :
             {GL_CULL_FACE, GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB, GL_RASTERIZER_DISCARD,
              GL_POLYGON_OFFSET_FILL, GL_COLOR_LOGIC_OP, GL_DEPTH_CLAMP, GL_SAMPLE_ALPHA_TO_COVERAGE,
              GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_PRIMITIVE_RESTART,
              GL_CLIP_DISTANCE1, GL_BLEND, GL_SCISSOR_TEST, GL_DEPTH_TEST})
            glEnable(on);
        for (GLenum off : {GL_MULTISAMPLE, GL_DITHER}) glDisable(off);
        glDisablei(GL_BLEND, 2);
        glDisablei(GL_SCISSOR_TEST, 3);
        glLogicOp(GL_XOR);
        glPrimitiveRestartIndex(1);
        glPolygonOffset(-3, -100);
        glSampleCoverage(0.25f, GL_TRUE);
        glSampleMaski(0, 0);
        glStencilFunc(GL_NEVER, 1, 0xff);
        glStencilMask(0x0f);
        glBlendFuncSeparate(GL_ZERO, GL_DST_COLOR, GL_ONE, GL_SRC_COLOR);
        glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MIN);
        glBlendFunci(1, GL_DST_COLOR, GL_ONE);
        glBlendColor(0.1f, 0.2f, 0.3f, 0.4f);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        glColorMaski(1, GL_TRUE, GL_FALSE, GL_FALSE, GL_TRUE);
        glClearColor(0.5f, 0.25f, 1, 0);
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_NEVER);
        glCullFace(GL_FRONT);
        glFrontFace(GL_CW);
        glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
        glViewport(2, 1, 3, 2);
        glViewportIndexedf(1, 0.5f, 1, 7, 8);
        glDepthRange(0.75, 0.25);
        glDepthRangeIndexed(2, 0.5, 0.75);
        glScissor(1, 1, 2, 2);
        for (GLenum rows : {GL_UNPACK_ROW_LENGTH, GL_PACK_ROW_LENGTH}) glPixelStorei(rows, 3);
        for (GLenum skip : {GL_UNPACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS}) glPixelStorei(skip, 2);
        for (GLenum align : {GL_UNPACK_ALIGNMENT, GL_PACK_ALIGNMENT}) glPixelStorei(align, 8);
        glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
        for (GLenum target :
             {GL_ARRAY_BUFFER, GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, GL_DRAW_INDIRECT_BUFFER,
              GL_DISPATCH_INDIRECT_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER, GL_TEXTURE_BUFFER})
            glBindBuffer(target, buffer_);
        for (GLuint i = 0; i < 8; ++i) {
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, buffer_, 1024 * i, 512);
            glBindBufferBase(GL_UNIFORM_BUFFER, i, buffer_);
        }
        glBindBuffer(GL_UNIFORM_BUFFER, 0);
        for (GLuint unit = 0; unit < 20; ++unit) {
            glBindTextureUnit(unit, pixels_.name());
            glBindTextureUnit(unit, view_);
            glBindSampler(unit, sampler_.name());
        }
        glActiveTexture(GL_TEXTURE0 + 11);
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, captured_);
        glBindVertexArray(corners_.name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
        glUseProgram(program_.name());
    }

    gl::Visit before_;  // what comes after finds it as it was
    gl::Texture pixels_;
    gl::Program program_;
    gl::VertexArray corners_;
    gl::Framebuffer framebuffer_;
    gl::Sampler sampler_;
    GLuint buffer_ = 0, view_ = 0, captured_ = 0;
};

/// Fails where something of the state is not as it was, and says what.
inline void expect_untouched(const std::map<std::string, std::vector<GLint64>>& before,
                             const std::string& after) {
    for (const auto& [name, now] : state_of_context())
        EXPECT_EQ(now, before.at(name)) << name << ", " << after;
}

}  // namespace palpate
