#pragma once
#include "palpate/body/embedding.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/program.h"

#include <optional>
#include <string>

namespace palpate {

/// An embedding in the memory of a GPU, and the GLSL by which a vertex shader maps each vertex where it is
/// drawn: what deform() does on the host. For our shaders and for those of other OpenGL applications.
/// Move-only; its context (4.5 core) must be current whenever it is used, and when it ends. With that context
/// current, an application
///
/// 1. makes one of these, and a vertex shader out of its shader() and a text of its own, as two shaders of
///    one program or as one text, which declares
///        void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent);
///    and calls it: position in m; normal unit; tangent unit, at right angles to the normal, w its handedness
///    (undefined where the embedding has no tangents);
/// 2. gives vertex_array() its triangles (glVertexArrayElementBuffer), with the vertex indices of the mesh
///    that was embedded, and, if it likes, attributes of its own, from `free_attribute` on;
/// 3. for each frame puts the nodes' positions into a buffer or texture by any shader, calls bind() and
///    then, with its own program in use, glDrawElements(GL_TRIANGLES, ...).
///
/// The shader takes the buffer bindings 0 to 2 or, for nodes in textures, the texture units 2 and 3 and the
/// buffer binding 2; bind() also uses 3 to 5. In one text with it, the names of mapping.inl are taken.
class GpuEmbedding {
 public:
    static constexpr GLuint free_attribute = 8;  // those below are the embedding's

    explicit GpuEmbedding(const Embedding& embedding);

    /// The GLSL of map_vertex(), without a #version line: that must be 450 core. `in_textures`: whether it
    /// reads the nodes from textures (GpuNodes::width > 0) rather than from buffers.
    std::string shader(bool in_textures = false) const;

    /// Vertices that are drawn next follow these nodes, as shaders have left them so far. Binds
    /// vertex_array() and what shader() reads. With frames it also runs a compute shader, so bind your own
    /// program after it. Normals are needed if needs_normals() says so.
    void bind(const GpuNodes& nodes) const;

    GLuint vertex_array() const { return corners_.name(); }
    bool needs_normals() const { return needs_normals_; }
    bool has_tangents() const { return has_tangents_; }
    std::size_t nodes() const { return nodes_; }  // how many there must be

 private:
    // The frames that vertices follow, and the programs that find them.
    struct Frames {
        std::size_t count;
        gl::Buffer rest, spokes, faces, found;
        gl::Program from_buffers, from_textures;
        explicit Frames(const Framed& framed);
    };

    void attach(const std::vector<InCell>& vertices);
    void attach(const std::vector<OnTriangle>& vertices);
    void attach(const Framed& framed);
    void attach_tangents(const std::vector<vec4>& tangents);

    gl::VertexArray corners_;
    gl::Buffer vertices_, tangents_;
    gl::Sampler exact_;  // nearest texel: so a texture without mipmaps can be read, however its owner set it
                         // up
    std::optional<Frames> frames_;
    const char* kind_ = nullptr;  // how a vertex of this kind follows, in GLSL
    bool needs_normals_ = false;
    bool has_tangents_ = false;
    std::size_t nodes_ = 0;
};

/// The GLSL with which every shader that reads nodes begins: node_position(), node_normal(), and mapping.inl.
std::string nodes_shader(bool in_textures);

}  // namespace palpate
