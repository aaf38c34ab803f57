#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/program.h"
#include "palpate/mesh/mesh.h"
#include "palpate/render/shadow_map.h"

namespace palpate {

/// Computes the ambient occlusion of a mesh at its vertices: how much of the sky each sees, from 1 on a
/// convex surface that nothing hides to nearly 0 at the bottom of a groove. The sky is sampled by many
/// parallel lights from all sides, each with a shadow map.
class AmbientOcclusion {
 public:
    AmbientOcclusion();

    /// One float for each vertex. `depth` draws positions into a shadow map, as in Programs::placed.
    gl::Buffer measure(const Mesh& mesh, const gl::Program& depth) const;

 private:
    ShadowMap map_;
    gl::Program gather_;
};

}  // namespace palpate
