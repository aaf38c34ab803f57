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
    float shine = 0.6f;                      // of the specular reflection: 0 as dull as chalk, 1 as wet as an
                                             // eye
    int colour_map = -1;  // a number from Renderer::add(image): a texture that multiplies `colour`; -1: none
    int normal_map = -1;  // the same, of a normal map in tangent space; -1: none
    bool shows_normals = false;  // its colour shows the direction of its vertex normals now (2005, figure 6)
    bool coarse_dents = false;   // dents turn normals per vertex and not per pixel: faster, and rough where
                                 // triangles are larger than dents (2007, section IV.B)
};

/// A mesh where it is now, given by the positions of its vertices or, if it was added with an embedding, of
/// the nodes that they follow. The spans are read during Renderer::draw only.
struct Surface {
    int mesh = 0;                          // a number from Renderer::add
    std::span<const vec3> positions = {};  // m, one a vertex of the mesh; or empty
    std::span<const vec3> normals = {};    // unit
    Look look = {};
    Nodes nodes = {};         // where there are no positions: on the host, to be sent to the GPU,
    GpuNodes gpu_nodes = {};  // or on the GPU already, in the renderer's context
    /// Its dents; most_dents of those that act are shown. The near and far planes are placed without them, so
    /// a bump far above everything may be cut off.
    std::span<const Dent> dents = {};
    /// Where there are positions: texture coordinates now, one a vertex, in place of the mesh's own; or
    /// empty.
    std::span<const vec2> uvs = {};
};

/// A wireframe, such as the springs of a lattice. What a surface hides of it shines through faintly.
struct Wires {
    std::span<const vec3> points = {};  // m
    std::span<const uvec2> lines = {};  // pairs of indices into the points
    vec3 colour = vec3(0.02f, 0.1f, 0.3f);
};

/// A round thing, such as the tip of a tool.
struct Ball {
    vec3 centre = vec3(0);  // m
    float radius = 0.006f;  // m
    vec3 colour = vec3(0.75f, 0.76f, 0.8f);
};

/// The plane of points p with dot(normal, p) = offset. It is shown around the things that are drawn, and only
/// from the side to which its normal points.
struct Ground {
    vec3 normal = vec3(0, 1, 0);  // need not be unit
    float offset = 0;             // m, for a unit normal
};

/// Everything that one frame shows. Plain data; an empty one shows the background.
struct Picture {
    Camera camera = {};
    Light light = {};
    std::vector<Surface> surfaces = {};
    std::vector<Wires> wires = {};
    std::vector<Ball> balls = {};
    std::vector<Ground> grounds = {};
    /// Whether clusters outside the view frustum, and clusters of back faces, are culled before a surface is
    /// mapped on the GPU. No pixel depends on it.
    bool culls = true;
};

}  // namespace palpate
