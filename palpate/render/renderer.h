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

/// How well pictures are drawn, at the price of speed.
struct Quality {
    int samples = 4;      // of each pixel, for smooth edges (multisampling): 1, 2, 4 or 8, or as many as the
                          // driver has
    bool shadows = true;  // which things cast on themselves and on each other
    float scale = 1;      // 0.25 to 1: multiplies the number of pixels each way
    bool every_triangle = true;  // of a mesh; if not, a simplified level of detail of at most about 24,000
                                 // triangles, on the mesh's own vertices

    bool operator==(const Quality&) const = default;
};

/// For moving pictures that the CPU has to draw.
inline constexpr Quality draft_quality{
    .samples = 1, .shadows = false, .scale = 0.5f, .every_triangle = false};

/// What culling has kept of a surface, of how much.
struct Culled {
    std::size_t clusters = 0, clusters_drawn = 0;
    std::size_t vertices = 0, vertices_drawn = 0;  // vertices that two clusters share count twice
};

/// What the pixels of an image mean.
enum class Texels {
    colours,  // sRGB
    normals   // a normal map in tangent space: red along u, green along v, blue out of the surface; 128 is 0,
              // and 255 is 1
};

/// Draws pictures. Move-only. Every call makes the renderer's context current on the calling thread.
class Renderer {
 public:
    /// `context`: where to draw, such as the context of a solver on the GPU; it must outlive the renderer.
    /// Without one, the renderer makes its own. Throws Error if there is no OpenGL, or if it cannot draw
    /// pictures of that size.
    explicit Renderer(Offscreen size, const gl::Context* context = nullptr);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Sets the size of all further pictures. What was added stays; image() is black until the next frame.
    /// Throws Error if it cannot draw pictures of that size.
    void resize(Offscreen size);

    /// Sets the quality of all further pictures; the first of each kind takes longer, since its shaders are
    /// compiled. What was added stays; image() is black until the next frame. Throws Error if a number is out
    /// of range.
    void set(const Quality& quality);

    /// Forgets all meshes and images that were added: the next gets the number 0 again. Compiled shaders
    /// stay.
    void clear();

    /// Keeps what is constant of a mesh: its triangles and its ambient occlusion, which takes about a second
    /// to compute for 100,000 triangles on a software driver. Returns the number by which Surface::mesh names
    /// it. Throws Error if the mesh is not sound (check()).
    int add(const Mesh& mesh);

    /// The same for a mesh that follows nodes: the GPU maps its vertices where it draws them.
    int add(const Mesh& mesh, const Embedding& embedding);

    /// Keeps an image as a texture for surfaces whose mesh has texture coordinates; u goes to the right in it
    /// and v upwards, and outside 0 to 1 it repeats. A normal map shows only on a surface that was added with
    /// an embedding that has tangents and that is drawn by its nodes. Returns the number by which Look names
    /// it. Throws Error if the driver has no images of that size.
    int add(const Image& image, Texels texels = Texels::colours);

    /// Draws one frame. The same picture gives the same pixels, whatever state others have set in the
    /// context; that state is restored afterwards (gl/visit.h). Odd pictures are drawn as well as possible:
    /// empty ones, a camera that looks at its own eye, points that are not finite. Throws Error where a
    /// surface names a mesh or a map that was not added, where the number of its positions differs from that
    /// of its vertices, or where a line refers to a missing point.
    void draw(const Picture& picture);

    /// The last frame; black before the first. If Quality::scale is less than 1, it has only the pixels that
    /// were drawn.
    Image image() const;

    /// Copies the last frame into the framebuffer that is bound for drawing in the renderer's context, such
    /// as a window's, with its lower left corner at `corner`, stretched to full size. That framebuffer must
    /// have one sample a pixel. It gets the bytes of image() whether it is sRGB or not, also where a scissor
    /// is set.
    void show(ivec2 corner) const;

    /// What culling kept of a mesh when it was last drawn by its nodes, leaving shadows aside. It reads back
    /// from the GPU, so this is for measurements.
    Culled culled(int mesh) const;

    /// Names the driver, and counts its error messages.
    const gl::Context& context() const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
