#pragma once
#include "palpate/render/renderer.h"
#include "palpate/run/play.h"

#include <vector>

namespace palpate {

/// What a scene looks like: its surfaces, tools and colliders as meshes of a renderer, and a picture of them
/// at each moment. Scene and models must outlive it.
class Scenery {
 public:
    enum class Mapped {
        where_nodes_are,  // on the GPU if one moves them, or if a normal map wants tangents; else on the CPU
        either            // as the play has them: one scenery serves plays on any backend
    };
    Scenery(const Scene& scene, const Models& made, Renderer& renderer,
            Mapped mapped = Mapped::where_nodes_are);

    /// The same shapes, of another scene and other models from now on, which were changed in nothing that can
    /// be seen.
    void now_of(const Scene& scene, const Models& made) {
        scene_ = &scene;
        made_ = &made;
    }

    /// Valid until the next call. `springs`: draw those of bodies over their surfaces.
    Picture picture(double time, const Play& play, const Camera& camera, bool springs = false);

 private:
    struct Shape {
        Mesh rest, now;  // of a collider: as it is given, and where it is
        int mesh = 0;
    };
    Shape shape_of(const Collider& collider, Renderer& renderer) const;
    bool mapped_where_drawn(std::size_t body) const;
    void add_bodies(const Play& play, bool springs, Picture& picture);
    void add_shafts(const Play& play, Picture& picture);
    void add_tools(const Play& play, Picture& picture);
    void add_colliders(const std::vector<Motion>& motions, Picture& picture);

    const Scene* scene_;
    const Models* made_;
    const Mapped mapped_;
    std::vector<int> meshes_;  // of the bodies' surfaces, and those that nothing moves
    std::vector<Look> looks_;
    std::vector<std::vector<uvec2>> springs_;  // of the bodies, once somebody wants to see them
    std::vector<Shape> shapes_;                // one a collider
    std::vector<vec3> drag_points_;            // where each drag pulls from and to
    std::vector<uvec2> drag_lines_;            // between those
    std::vector<Shape> shafts_;                // one a tool
    std::vector<std::vector<Dent>> dents_;     // one list a surface
};

}  // namespace palpate
