#pragma once
#include "palpate/base/vectors.h"
#include "palpate/body/dent.h"
#include "palpate/body/nodes.h"
#include "palpate/scene/camera.h"

#include <span>
#include <vector>

namespace palpate {

/// What a surface looks like.
struct Look {
    vec3 colour = vec3(0.8f, 0.42f, 0.38f);  // linear red, green and blue, 0 to 1; living tissue by default
    float shine = 0.6f;                      // 0 as dull as chalk, 1 as wet as an eye
    int colour_map = -1;  // a number from Renderer::add(image): colours to multiply `colour` with; -1: none
    int normal_map = -1;  // the same, of normals about the surface's own; -1: none
    bool shows_normals = false;  // its colour is where its vertices' normals point now (2005, figure 6)
    bool coarse_dents = false;   // normals are turned by dents at its vertices and not in each pixel: faster,
                                 // and rough where triangles are larger than dents (2007, section IV.B)
};

/// A mesh where it is now: where its vertices are, or if it was added with an embedding, where the nodes are
/// that they hang on. The spans are read during Renderer::draw only.
struct Surface {
    int mesh = 0;                          // a number from Renderer::add
    std::span<const vec3> positions = {};  // m, one a vertex of the mesh; or empty
    std::span<const vec3> normals = {};    // unit
    Look look = {};
    Nodes nodes = {};         // where there are no positions: on the host, to be sent to the GPU,
    GpuNodes gpu_nodes = {};  // or on the GPU already, in the renderer's context
    /// Where it is dented; most_dents of those that act are shown. They do not count towards the extent of
    /// the things in the picture, so that a bump far above all of them may be cut off.
    std::span<const Dent> dents = {};
};

/// Thin lines, such as the springs of a lattice. What a surface hides of them shines through faintly.
struct Wires {
    std::span<const vec3> points = {};  // m
    std::span<const uvec2> lines = {};  // each between two of the points
    vec3 colour = vec3(0.02f, 0.1f, 0.3f);
};

/// A round thing, such as the tip of a tool.
struct Ball {
    vec3 centre = vec3(0);  // m
    float radius = 0.006f;  // m
    vec3 colour = vec3(0.75f, 0.76f, 0.8f);
};

/// The points p with dot(normal, p) = offset, shown around the things that are drawn, and only from the side
/// to which the normal points.
struct Ground {
    vec3 normal = vec3(0, 1, 0);  // need not be unit
    float offset = 0;             // m, for a unit normal
};

/// All that one frame shows. Plain data; an empty one shows the background.
struct Picture {
    Camera camera = {};
    Light light = {};
    std::vector<Surface> surfaces = {};
    std::vector<Wires> wires = {};
    std::vector<Ball> balls = {};
    std::vector<Ground> grounds = {};
    /// Whether what cannot be seen of surfaces that are mapped on the GPU is left out before that. No pixel
    /// depends on it.
    bool culls = true;
};

}  // namespace palpate
