#pragma once
#include "palpate/gl/context.h"
#include "palpate/render/renderer.h"
#include "palpate/run/experiment.h"
#include "palpate/run/scenery.h"

#include <optional>
#include <vector>

namespace palpate {

/// How an experiment is shown. Nothing of it changes what moves.
struct Look3d {
    bool wireframe = false;  // the triangles' edges over the surfaces
    bool springs = false;    // the lattice's
    bool normals = false;    // as colours (2005, figure 6)
    bool normal_maps = true;
    bool culling = true;

    bool operator==(const Look3d&) const = default;
};

/// What hands add to a picture: their tips, lines from what they hold, and dents.
struct Traces {
    std::vector<Ball> balls;
    std::vector<vec3> points;
    std::vector<uvec2> lines;
    std::vector<std::vector<Dent>> dents;  // one list a surface, or none at all
};

/// One picture in the window: an experiment as a renderer draws it.
class Pane {
 public:
    Pane(const gl::Context& context, ivec2 size) : renderer_({size.x, size.y}, &context), size_(size) {}

    void resize(ivec2 size);
    void set(const Quality& quality);

    void draw(const Experiment& experiment, const Camera& camera, const Look3d& look, const Traces& traces);

    /// Into the framebuffer that is bound, its lower left corner there.
    void show(ivec2 corner) const { renderer_.show(corner); }
    Image image() const { return renderer_.image(); }
    ivec2 size() const { return size_; }

 private:
    void add_wireframe(const Experiment& experiment, Picture& picture);

    Renderer renderer_;
    ivec2 size_;
    std::optional<Scenery> scenery_;
    Quality quality_;
    int shapes_ = -1;                        // what is shown: see Experiment::shapes
    std::vector<std::vector<uvec2>> edges_;  // of the surfaces, once somebody wants to see them
    std::vector<std::vector<Dent>> dents_;
};

}  // namespace palpate
