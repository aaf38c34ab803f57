#pragma once
#include "palpate/render/renderer.h"
#include "palpate/run/play.h"

#include <vector>

namespace palpate {

/// Draws a scene: adds its surfaces, tools and colliders to a renderer as meshes, and makes a Picture of them
/// at each moment. Scene and models must outlive it.
class Scenery {
 public:
    enum class Mapped {
        where_nodes_are,  // on the GPU if it moves them, or if a normal map needs tangents; else on the CPU
        either            // depends on the play: one scenery works for plays on any backend
    };
    Scenery(const Scene& scene, const Models& made, Renderer& renderer,
            Mapped mapped = Mapped::where_nodes_are);

    /// Switches to another scene and other models with the same appearance.
    void now_of(const Scene& scene, const Models& made) {
        scene_ = &scene;
        made_ = &made;
    }

    /// Valid until the next call. `springs`: draws those of bodies over their surfaces, as a wireframe.
    Picture picture(double time, const Play& play, const Camera& camera, bool springs = false);

 private:
    struct Shape {
        Mesh rest, now;  // of a collider: as given, and moved
        int mesh = 0;
    };
    Shape shape_of(const Collider& collider, Renderer& renderer) const;
    bool is_hidden(const ToolRecipe& tool) const;
    bool mapped_where_drawn(std::size_t body) const;
    void add_bodies(const Play& play, bool springs, Picture& picture);
    void add_shafts(const Play& play, Picture& picture);
    void add_tools(const Play& play, Picture& picture);
    void add_colliders(const std::vector<Motion>& motions, Picture& picture);

    const Scene* scene_;
    const Models* made_;
    const Mapped mapped_;
    std::vector<int> meshes_;  // of the bodies' surfaces and the static surfaces
    std::vector<Look> looks_;
    std::vector<std::vector<uvec2>> springs_;  // of the bodies, made on first use
    std::vector<Shape> shapes_;                // one for each collider
    std::vector<std::vector<vec2>> pressed_;   // of the bodies whose pressure is shown, one a vertex
    std::vector<vec3> drag_points_;            // the two ends of each drag's spring
    std::vector<uvec2> drag_lines_;            // between those points
    std::vector<Shape> shafts_;                // one for each tool
    std::vector<std::vector<Dent>> dents_;     // one list for each surface
};

}  // namespace palpate
