#pragma once
#include "palpate/gl/context.h"
#include "palpate/render/renderer.h"
#include "palpate/run/experiment.h"
#include "palpate/run/scenery.h"
#include "palpate/viewer/options.h"

#include <optional>
#include <vector>

namespace palpate {

/// What interactions add to a picture: tips, lines to what they hold, and dents.
struct Traces {
    std::vector<Ball> balls;
    std::vector<vec3> points;
    std::vector<uvec2> lines;
    std::vector<std::vector<Dent>> dents;  // one list for each surface, or none

    void add_line(vec3 from, vec3 to) {
        lines.push_back(uvec2(points.size(), points.size() + 1));
        points.insert(points.end(), {from, to});
    }
};
inline const vec3 hand_colour(0.95f, 0.6f, 0.1f), proxy_colour(0.1f, 0.45f, 0.85f);

/// One picture in the window: an experiment with its renderer.
class Pane {
 public:
    Pane(const gl::Context& context, ivec2 size) : renderer_({size.x, size.y}, &context), size_(size) {}

    void resize(ivec2 size);
    void set(const Quality& quality);

    /// Takes a copy of what shall be drawn, so that the experiment may advance on another thread during
    /// draw().
    void look(const Experiment& experiment, const Camera& camera, const Look3d& look, const Traces& traces);
    void draw(const Camera& camera);

    /// Copies it into the framebuffer that is bound, with its lower left corner there.
    void show(ivec2 corner) const { renderer_.show(corner); }
    Image image() const { return renderer_.image(); }
    ivec2 size() const { return size_; }

 private:
    void add_wireframe(const Experiment& experiment);
    void copy_all();

    Renderer renderer_;
    ivec2 size_;
    std::optional<Scenery> scenery_;
    Quality quality_;
    Experiment::Shapes shapes_;              // the shapes that are drawn
    std::vector<std::vector<uvec2>> edges_;  // of the surfaces, made on first use
    std::vector<std::vector<Dent>> dents_;
    Traces traces_;
    Picture picture_;
    std::vector<std::vector<vec3>> copies_;  // of the positions and normals in it
};

}  // namespace palpate
