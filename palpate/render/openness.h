#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/program.h"
#include "palpate/mesh/mesh.h"
#include "palpate/render/shadow_map.h"

namespace palpate {

/// Measures how much of the sky each vertex of a mesh sees: 1 on a free convex surface, towards 0 at the
/// bottom of a groove. The sky is many parallel lights from all sides, with a shadow map each.
class Openness {
 public:
    Openness();

    /// One float a vertex. `depth` draws places into a shadow map, as in Programs::placed.
    gl::Buffer measure(const Mesh& mesh, const gl::Program& depth) const;

 private:
    ShadowMap map_;
    gl::Program gather_;
};

}  // namespace palpate
