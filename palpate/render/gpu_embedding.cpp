#include "palpate/render/gpu_embedding.h"

#include "palpate/base/error.h"
#include "palpate/render/macros.h"

#include <algorithm>
#include <cstddef>

namespace palpate {
namespace {

const char* frames_comp =
#include "embedded/frames.comp.h"
    ;
const char* in_cells_glsl =
#include "embedded/in_cells.glsl.h"
    ;
const char* mapping_glsl =
#include "embedded/mapping.glsl.h"
    ;
const char* mapping_inl =
#include "embedded/mapping.inl.h"
    ;
const char* nodes_in_buffers_glsl =
#include "embedded/nodes_in_buffers.glsl.h"
    ;
const char* nodes_in_textures_glsl =
#include "embedded/nodes_in_textures.glsl.h"
    ;
const char* on_frames_glsl =
#include "embedded/on_frames.glsl.h"
    ;
const char* on_triangles_glsl =
#include "embedded/on_triangles.glsl.h"
    ;

constexpr int frames_group = 64;  // as in frames.comp

// Shaders read these in their layout in memory.
static_assert(sizeof(Frame) == 15 * 4 && sizeof(Spoke) == 4 * 4);

gl::Program finder(bool in_textures) {
    const std::string text = "#version 450 core\n" + nodes_shader(in_textures) + frames_comp;
    return gl::Program({{GL_COMPUTE_SHADER, "frames.comp", text}});
}

// Attributes of one vertex array that are interleaved in one buffer, as members of a `Vertex`.
template <class Vertex>
class Attributes {
 public:
    Attributes(GLuint corners, const gl::Buffer& vertices) : corners_(corners) {
        glVertexArrayVertexBuffer(corners_, 0, vertices.name(), 0, sizeof(Vertex));
    }
    void floats(GLuint number, int numbers, std::size_t offset) const {
        enable(number);
        glVertexArrayAttribFormat(corners_, number, numbers, GL_FLOAT, GL_FALSE, GLuint(offset));
    }
    void ints(GLuint number, int numbers, std::size_t offset) const {
        enable(number);
        glVertexArrayAttribIFormat(corners_, number, numbers, GL_INT, GLuint(offset));
    }

 private:
    void enable(GLuint number) const {
        glEnableVertexArrayAttrib(corners_, number);
        glVertexArrayAttribBinding(corners_, number, 0);
    }
    GLuint corners_;
};

}  // namespace

std::string nodes_shader(bool in_textures) {
    return std::string(macros_glsl) + mapping_inl +
           (in_textures ? nodes_in_textures_glsl : nodes_in_buffers_glsl);
}

GpuEmbedding::Frames::Frames(const Framed& framed)
    : count(framed.frames.size()),
      rest(framed.frames),
      spokes(framed.spokes),
      faces(framed.faces),
      found(gl::Buffer::room(count * sizeof(mat4))),
      from_buffers(finder(false)),
      from_textures(finder(true)) {}

GpuEmbedding::GpuEmbedding(const Embedding& embedding)
    : has_tangents_(!embedding.tangents.empty()), nodes_(embedding.nodes) {
    std::visit([&](const auto& vertices) { attach(vertices); }, embedding.vertices);
    if (has_tangents_) attach_tangents(embedding.tangents);
    glSamplerParameteri(exact_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(exact_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// The numbers of the attributes are those in the kind's GLSL.

void GpuEmbedding::attach(const std::vector<InCell>& vertices) {
    kind_ = in_cells_glsl;
    vertices_ = gl::Buffer(vertices);
    const Attributes<InCell> attributes(corners_.name(), vertices_);
    attributes.floats(0, 3, offsetof(InCell, normal));
    attributes.floats(2, 3, offsetof(InCell, at));
    attributes.ints(3, 4, offsetof(InCell, nodes));
    attributes.ints(4, 4, offsetof(InCell, nodes) + 4 * sizeof(int));
}

void GpuEmbedding::attach(const std::vector<OnTriangle>& vertices) {
    kind_ = on_triangles_glsl;
    vertices_ = gl::Buffer(vertices);
    needs_normals_ =
        std::any_of(vertices.begin(), vertices.end(), [](const auto& v) { return v.curvature > 0; });
    const Attributes<OnTriangle> attributes(corners_.name(), vertices_);
    attributes.floats(0, 3, offsetof(OnTriangle, normal));
    attributes.floats(2, 3, offsetof(OnTriangle, weights));
    attributes.floats(3, 3, offsetof(OnTriangle, offset));
    attributes.floats(4, 1, offsetof(OnTriangle, curvature));
    attributes.ints(5, 3, offsetof(OnTriangle, nodes));
}

void GpuEmbedding::attach(const Framed& framed) {
    kind_ = on_frames_glsl;
    vertices_ = gl::Buffer(framed.vertices);
    frames_.emplace(framed);
    const Attributes<OnFrames> attributes(corners_.name(), vertices_);
    attributes.floats(0, 3, offsetof(OnFrames, normal));
    attributes.floats(2, 3, offsetof(OnFrames, weights));
    for (GLuint k = 0; k < 3; ++k) attributes.floats(3 + k, 3, offsetof(OnFrames, arms) + k * sizeof(vec3));
    attributes.ints(6, 3, offsetof(OnFrames, frames));
}

void GpuEmbedding::attach_tangents(const std::vector<vec4>& tangents) {
    tangents_ = gl::Buffer(tangents);
    glEnableVertexArrayAttrib(vertex_array(), 1);
    glVertexArrayAttribFormat(vertex_array(), 1, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayVertexBuffer(vertex_array(), 1, tangents_.name(), 0, sizeof(vec4));
}

std::string GpuEmbedding::shader(bool in_textures) const {
    return nodes_shader(in_textures) + kind_ + mapping_glsl + macros_end_glsl;
}

void GpuEmbedding::bind(const GpuNodes& nodes) const {
    if (nodes.positions == 0 || (nodes.normals == 0 && needs_normals_))
        throw Error("no positions of nodes, or no normals where the mapping needs them", "the GPU's nodes",
                    "fill in both");
    const GLuint normals = nodes.normals != 0 ? nodes.normals : nodes.positions;  // never read, but something
                                                                                  // must be bound
    const bool in_textures = nodes.width > 0;
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    if (in_textures) {
        glBindTextureUnit(2, nodes.positions);
        glBindTextureUnit(3, normals);
        glBindSampler(2, exact_.name());
        glBindSampler(3, exact_.name());
    } else {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, nodes.positions);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, normals);
    }
    if (frames_) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, frames_->found.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, frames_->rest.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, frames_->spokes.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, frames_->faces.name());
        (in_textures ? frames_->from_textures : frames_->from_buffers).use();
        glDispatchCompute(GLuint((frames_->count + frames_group - 1) / frames_group), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    glBindVertexArray(vertex_array());
}

}  // namespace palpate
