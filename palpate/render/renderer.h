#pragma once
#include "palpate/body/embedding.h"
#include "palpate/mesh/image.h"
#include "palpate/mesh/mesh.h"
#include "palpate/render/picture.h"

#include <memory>

namespace palpate {

namespace gl {
class Context;
}

/// A picture in memory, in pixels.
struct Offscreen {
    int width = 1280;
    int height = 720;
};

/// How well pictures are drawn, and so how fast.
struct Quality {
    int samples = 4;      // of each pixel, for smooth edges: 1, 2, 4 or 8, or as many as the driver has
    bool shadows = true;  // that things cast on themselves and each other
    float scale = 1;      // 0.25 to 1: drawn with so many times as many pixels each way
    bool every_triangle = true;  // of a mesh; or at most about 24,000, between vertices that it has

    bool operator==(const Quality&) const = default;
};

/// For things that move where the CPU has to draw them.
inline constexpr Quality draft_quality{
    .samples = 1, .shadows = false, .scale = 0.5f, .every_triangle = false};

/// What was left out of a surface before it was mapped, and what was not.
struct Culled {
    std::size_t clusters = 0, clusters_drawn = 0;
    std::size_t vertices = 0, vertices_drawn = 0;  // those that two clusters share count twice
};

/// What the pixels of an image mean.
enum class Texels {
    colours,  // sRGB
    normals   // red along u, green along v, blue out of the surface; 128 is 0, and 255 is 1
};

/// Draws pictures. Move-only. Every call makes the renderer's context current on its thread.
class Renderer {
 public:
    /// In a context that has to outlive it, such as that of a solver on the GPU, or if none is given in one
    /// of its own. Throws Error if there is no OpenGL, or if it cannot draw pictures of that size.
    explicit Renderer(Offscreen size, const gl::Context* context = nullptr);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Pictures have that size from now on. What was added stays; image() is black until the next frame.
    /// Throws Error if it cannot draw pictures of that size.
    void resize(Offscreen size);

    /// Pictures have that quality from now on; the first of each kind takes longer, since its programs are
    /// compiled. What was added stays; image() is black until the next frame. Throws Error for numbers that a
    /// quality cannot have.
    void set(const Quality& quality);

    /// Forgets all meshes and images that were added: the next has the number 0 again. What was compiled to
    /// draw them stays.
    void clear();

    /// Keeps what does not move of a mesh: its triangles, and how deep each vertex lies in a groove, which
    /// takes about a second for 100,000 triangles on a software driver. Returns the number by which
    /// Surface::mesh names it. Throws Error if the mesh is not sound (check()).
    int add(const Mesh& mesh);

    /// The same for a mesh that hangs on nodes: its vertices are mapped where they are drawn, on the GPU.
    int add(const Mesh& mesh, const Embedding& embedding);

    /// Keeps an image to be laid over surfaces whose mesh has texture coordinates; u goes to the right in it
    /// and v upwards, and beyond 0 and 1 it is repeated. A normal map needs a surface that was added with an
    /// embedding which has tangents, and that is drawn by its nodes; over others nothing is laid. Returns the
    /// number by which Look names it. Throws Error if the driver has no images of that size.
    int add(const Image& image, Texels texels = Texels::colours);

    /// Draws one frame. Same picture, same pixels, whatever others have set in the context, who find it
    /// afterwards as they left it (gl/visit.h). Odd pictures are drawn as well as they can be: nothing in
    /// them, a camera that looks at its own eye, points that are not finite. Throws Error where a surface
    /// names a mesh or a map that was not added, or has not as many places as that, or a line has no such
    /// point.
    void draw(const Picture& picture);

    /// The last frame that was drawn; black before the first. Where Quality::scale is less than 1 it has
    /// fewer pixels, as they were drawn.
    Image image() const;

    /// Puts the last frame into the framebuffer that is bound for drawing in the renderer's context, such as
    /// a window's, with its lower left corner at `corner`: in full size, so stretched where it has fewer
    /// pixels. That framebuffer has one sample a pixel; whether it is sRGB or not, it gets the bytes of
    /// image(), also where a scissor is set.
    void show(ivec2 corner) const;

    /// What was left out of a mesh when it was last drawn by its nodes, not counting its shadow. Reads that
    /// back, so this is for measurements.
    Culled culled(int mesh) const;

    /// Names the driver, and counts its complaints.
    const gl::Context& context() const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
