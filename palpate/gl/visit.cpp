#include "palpate/gl/visit.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>

namespace palpate::gl {
namespace {

// The switches (glEnable) that are off during a visit, and those that are on.
constexpr GLenum switched_off[] = {GL_CULL_FACE,           GL_DEPTH_TEST,
                                   GL_STENCIL_TEST,        GL_FRAMEBUFFER_SRGB,
                                   GL_RASTERIZER_DISCARD,  GL_POLYGON_OFFSET_FILL,
                                   GL_POLYGON_SMOOTH,      GL_COLOR_LOGIC_OP,
                                   GL_DEPTH_CLAMP,         GL_SAMPLE_ALPHA_TO_COVERAGE,
                                   GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE,
                                   GL_SAMPLE_MASK,         GL_SAMPLE_SHADING,
                                   GL_PRIMITIVE_RESTART,   GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                   GL_CLIP_DISTANCE0,      GL_CLIP_DISTANCE1,
                                   GL_CLIP_DISTANCE2,      GL_CLIP_DISTANCE3,
                                   GL_CLIP_DISTANCE4,      GL_CLIP_DISTANCE5,
                                   GL_CLIP_DISTANCE6,      GL_CLIP_DISTANCE7};
constexpr GLenum switched_on[] = {GL_MULTISAMPLE, GL_DITHER};

// The parameters of pixel storage (glPixelStore), with their defaults.
constexpr struct {
    GLenum name;
    GLint usual;
} pixel_rows[] = {{GL_UNPACK_SWAP_BYTES, 0},  {GL_UNPACK_LSB_FIRST, 0},    {GL_UNPACK_ROW_LENGTH, 0},
                  {GL_UNPACK_SKIP_ROWS, 0},   {GL_UNPACK_SKIP_PIXELS, 0},  {GL_UNPACK_ALIGNMENT, 4},
                  {GL_UNPACK_SKIP_IMAGES, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0}, {GL_PACK_SWAP_BYTES, 0},
                  {GL_PACK_LSB_FIRST, 0},     {GL_PACK_ROW_LENGTH, 0},     {GL_PACK_SKIP_ROWS, 0},
                  {GL_PACK_SKIP_PIXELS, 0},   {GL_PACK_ALIGNMENT, 4},      {GL_PACK_SKIP_IMAGES, 0},
                  {GL_PACK_IMAGE_HEIGHT, 0}};

// The texture targets that are used here, each with the query for its binding.
constexpr struct {
    GLenum target, binding;
} texture_kinds[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                     {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER},
                     {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE}};

constexpr GLuint most_targets = 8;     // colour attachments that a fragment shader writes
constexpr GLuint most_viewports = 16;  // the minimum that a driver must offer

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}
GLuint bound(GLenum name) { return GLuint(integer(name)); }
GLint integer(GLenum name, GLuint index) {
    GLint value = 0;
    glGetIntegeri_v(name, index, &value);
    return value;
}

void turn(GLenum name, bool on) { (on ? glEnable : glDisable)(name); }
void turn(GLenum name, GLuint index, bool on) { (on ? glEnablei : glDisablei)(name, index); }

// The blending and the write mask of one colour attachment.
struct Colour {
    bool blends = false;
    GLint from_rgb = 0, to_rgb = 0, from_alpha = 0, to_alpha = 0, rgb = 0, alpha = 0;
    GLboolean mask[4] = {};

    Colour() = default;
    explicit Colour(GLuint target)
        : blends(glIsEnabledi(GL_BLEND, target)),
          from_rgb(integer(GL_BLEND_SRC_RGB, target)),
          to_rgb(integer(GL_BLEND_DST_RGB, target)),
          from_alpha(integer(GL_BLEND_SRC_ALPHA, target)),
          to_alpha(integer(GL_BLEND_DST_ALPHA, target)),
          rgb(integer(GL_BLEND_EQUATION_RGB, target)),
          alpha(integer(GL_BLEND_EQUATION_ALPHA, target)) {
        glGetBooleani_v(GL_COLOR_WRITEMASK, target, mask);
    }
    void put_back(GLuint target) const {
        turn(GL_BLEND, target, blends);
        glBlendFuncSeparatei(target, GLenum(from_rgb), GLenum(to_rgb), GLenum(from_alpha), GLenum(to_alpha));
        glBlendEquationSeparatei(target, GLenum(rgb), GLenum(alpha));
        glColorMaski(target, mask[0], mask[1], mask[2], mask[3]);
    }
};

// A viewport, with its depth range and scissor box.
struct Window {
    GLfloat viewport[4] = {};
    GLdouble depth[2] = {};
    bool cuts = false;

    Window() = default;
    explicit Window(GLuint index) : cuts(glIsEnabledi(GL_SCISSOR_TEST, index)) {
        glGetFloati_v(GL_VIEWPORT, index, viewport);
        glGetDoublei_v(GL_DEPTH_RANGE, index, depth);
    }
    void put_back(GLuint index) const {
        glViewportIndexedfv(index, viewport);
        glDepthRangeIndexed(index, depth[0], depth[1]);
        turn(GL_SCISSOR_TEST, index, cuts);
    }
};

struct TextureUnit {
    std::array<GLuint, std::size(texture_kinds)> textures;
    GLuint sampler = 0;
};

// A binding of a buffer or of a range of it.
struct Range {
    GLuint buffer = 0;
    GLint64 start = 0, size = 0;

    Range() = default;
    Range(GLenum binding, GLenum starts, GLenum sizes, GLuint index)
        : buffer(GLuint(integer(binding, index))) {
        glGetInteger64i_v(starts, index, &start);
        glGetInteger64i_v(sizes, index, &size);
    }
    void put_back(GLenum target, GLuint index) const {
        if (buffer != 0 && size > 0)
            glBindBufferRange(target, index, buffer, GLintptr(start), GLsizeiptr(size));
        else
            glBindBufferBase(target, index, buffer);
    }
};

template <class T, std::size_t count>
std::array<T, count> each() {
    std::array<T, count> all;
    for (GLuint i = 0; i < count; ++i) all[i] = T(i);
    return all;
}
template <class T, std::size_t count>
void put_back(const std::array<T, count>& all) {
    for (GLuint i = 0; i < count; ++i) all[i].put_back(i);
}

}  // namespace

struct Visit::Kept {
    std::array<bool, std::size(switched_off)> off;
    std::array<bool, std::size(switched_on)> on;
    std::array<GLint, std::size(pixel_rows)> rows;
    std::array<Colour, most_targets> colours = each<Colour, most_targets>();
    std::array<Window, most_viewports> windows = each<Window, most_viewports>();
    std::array<TextureUnit, units> textures;
    std::array<Range, buffers> storage, uniforms;

    GLint depth_function = integer(GL_DEPTH_FUNC), culled = integer(GL_CULL_FACE_MODE),
          front = integer(GL_FRONT_FACE), provoking = integer(GL_PROVOKING_VERTEX),
          origin = integer(GL_CLIP_ORIGIN), clip_depth = integer(GL_CLIP_DEPTH_MODE),
          depth_is_written = integer(GL_DEPTH_WRITEMASK), active_unit = integer(GL_ACTIVE_TEXTURE);
    GLuint program = bound(GL_CURRENT_PROGRAM), corners = bound(GL_VERTEX_ARRAY_BINDING),
           drawn = bound(GL_DRAW_FRAMEBUFFER_BINDING), read = bound(GL_READ_FRAMEBUFFER_BINDING),
           captured = bound(GL_TRANSFORM_FEEDBACK_BINDING), commands = bound(GL_DRAW_INDIRECT_BUFFER_BINDING),
           unpacked = bound(GL_PIXEL_UNPACK_BUFFER_BINDING), packed = bound(GL_PIXEL_PACK_BUFFER_BINDING),
           storage_buffer = bound(GL_SHADER_STORAGE_BUFFER_BINDING),
           uniform_buffer = bound(GL_UNIFORM_BUFFER_BINDING);

    GLint polygons[2] = {};  // of front and back faces, which core OpenGL does not distinguish

    Kept();
    void set_defaults() const;
    void put_back() const;
};

Visit::Kept::Kept() {
    glGetIntegerv(GL_POLYGON_MODE, polygons);
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = glIsEnabled(switched_off[i]);
    for (std::size_t i = 0; i < on.size(); ++i) on[i] = glIsEnabled(switched_on[i]);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = integer(pixel_rows[i].name);
    for (GLuint unit = 0; unit < units; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (std::size_t k = 0; k < std::size(texture_kinds); ++k)
            textures[unit].textures[k] = bound(texture_kinds[k].binding);
        textures[unit].sampler = bound(GL_SAMPLER_BINDING);
    }
    glActiveTexture(GLenum(active_unit));
    for (GLuint i = 0; i < buffers; ++i) {
        storage[i] = Range(GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                           GL_SHADER_STORAGE_BUFFER_SIZE, i);
        uniforms[i] = Range(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE, i);
    }
}

void Visit::Kept::set_defaults() const {
    for (GLenum name : switched_off) glDisable(name);
    for (GLenum name : switched_on) glEnable(name);
    for (GLenum name : {GL_BLEND, GL_SCISSOR_TEST}) glDisable(name);  // at every index
    for (const auto& [name, usual] : pixel_rows) glPixelStorei(name, usual);
    glBlendFunc(GL_ONE, GL_ZERO);
    glBlendEquation(GL_FUNC_ADD);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDepthRange(0, 1);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindSamplers(0, units, nullptr);
}

void Visit::Kept::put_back() const {
    for (std::size_t i = 0; i < off.size(); ++i) turn(switched_off[i], off[i]);
    for (std::size_t i = 0; i < on.size(); ++i) turn(switched_on[i], on[i]);
    for (std::size_t i = 0; i < rows.size(); ++i) glPixelStorei(pixel_rows[i].name, rows[i]);
    gl::put_back(colours);
    gl::put_back(windows);
    glDepthMask(GLboolean(depth_is_written));
    glDepthFunc(GLenum(depth_function));
    glCullFace(GLenum(culled));
    glFrontFace(GLenum(front));
    glPolygonMode(GL_FRONT_AND_BACK, GLenum(polygons[0]));
    glProvokingVertex(GLenum(provoking));
    glClipControl(GLenum(origin), GLenum(clip_depth));
    for (GLuint unit = 0; unit < units; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (std::size_t k = 0; k < std::size(texture_kinds); ++k)
            glBindTexture(texture_kinds[k].target, textures[unit].textures[k]);
        glBindSampler(unit, textures[unit].sampler);
    }
    glActiveTexture(GLenum(active_unit));
    for (GLuint i = 0; i < buffers; ++i) {
        storage[i].put_back(GL_SHADER_STORAGE_BUFFER, i);
        uniforms[i].put_back(GL_UNIFORM_BUFFER, i);
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, storage_buffer);
    glBindBuffer(GL_UNIFORM_BUFFER, uniform_buffer);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, unpacked);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, captured);
    glBindVertexArray(corners);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, drawn);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, read);
    glUseProgram(program);
}

Visit::Visit() : kept_(std::make_unique<Kept>()) { kept_->set_defaults(); }
Visit::~Visit() { kept_->put_back(); }

}  // namespace palpate::gl
