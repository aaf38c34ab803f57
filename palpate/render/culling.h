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

/// Finds which clusters of a surface that hangs on nodes can be seen, before any of its vertices is mapped:
/// by the GPU, from the nodes alone. What is left out has no pixel, whatever the deformation: a cluster lies
/// beyond one side of what is seen, or (in cells, where deformation bends little) all of it shows its back.
/// Move-only; its context must be current whenever it is used, and when it ends.
class Culling {
 public:
    Culling(const Clusters& clusters, const Mesh& mesh, const Embedding& embedding);

    /// For the nodes that GpuEmbedding::bind has bound; `in_textures` says how. A compute shader, so a
    /// program must be put to use after it. `hides_backs`: whether triangles that show their backs are not
    /// drawn. `moved`: how far vertices may lie from where the embedding puts them, m.
    void find(const View& view, bool hides_backs, bool in_textures, float moved) const;

    /// Draws what find() has found, from the vertex array that is bound, to which Clusters::triangles belong.
    void draw() const;

    /// What find() found last. Reads it back, so this is for measurements.
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
