#pragma once
#include "palpate/body/embedding.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/gl/program.h"
#include "palpate/render/clusters.h"
#include "palpate/render/renderer.h"
#include "palpate/render/view.h"

#include <cstddef>
#include <vector>

namespace palpate {

/// View-frustum and back-face culling of a surface that follows nodes, by clusters. A compute shader decides
/// from the nodes alone, before any vertex is mapped. The test is conservative: a cluster is left out only if
/// it lies outside the frustum, or if all its triangles are back faces (known only in cells, where the
/// deformation bends little), so no pixel changes. Move-only; its context must be current whenever it is
/// used, and when it ends.
class Culling {
 public:
    Culling(const Clusters& clusters, const Mesh& mesh, const Embedding& embedding);

    /// Culls for the nodes that GpuEmbedding::bind has bound, in textures if `in_textures`. It runs a compute
    /// shader, so bind your own program after it. `culls_back_faces`: whether back faces are not drawn.
    /// `moved`: how far vertices may lie from where the embedding puts them, m.
    void find(const View& view, bool culls_back_faces, bool in_textures, float moved) const;

    /// Draws the clusters that find() has kept, from the vertex array that is bound, whose index buffer holds
    /// Clusters::triangles.
    void draw() const;

    /// How many find() kept. It reads back from the GPU, so this is for measurements.
    Culled count(const gl::Context& context) const;

 private:
    struct Size {
        std::size_t vertices, corners_end;
    };
    std::vector<Size> sizes_;  // of each cluster
    gl::Buffer parts_, clusters_, commands_;
    gl::Program from_buffers_, from_textures_;
};

}  // namespace palpate
