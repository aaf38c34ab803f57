#pragma once
#include "palpate/render/renderer.h"
#include "palpate/run/film.h"
#include "palpate/run/play.h"
#include "palpate/run/run.h"

#include <memory>
#include <string>
#include <vector>

namespace palpate {

/// Draws a scene as it moves, into a film and single pictures.
class Show {
 public:
    /// In the context in which a GPU moves the bodies, if one does.
    Show(const Scene& scene, const Models& made, const RunSettings& settings,
         const gl::Context* context = nullptr);

    /// The OpenGL driver.
    const std::string& renderer() const;

    /// Frame 0 is the state before the first step. Returns whether it drew; the time goes to what it took it
    /// for.
    bool frame_done(int number, const Play& play, Report::Seconds& seconds);

    /// After the last frame.
    void finish();

 private:
    struct Shape {
        Mesh rest, now;  // of a collider: as it is given, and where it is
        int mesh = 0;
    };
    Shape shape_of(const Collider& collider);
    Look look(const BodyRecipe& recipe, const Model& model);
    bool mapped_where_drawn(std::size_t body) const;
    vec3 looked_at() const;
    Picture picture(double time, const Play& play);
    void add_shafts(const Play& play, Picture& picture);
    void add_tools(const Play& play, Picture& picture);
    void add_colliders(const std::vector<Motion>& motions, Picture& picture);

    const Scene& scene_;
    const Models& made_;
    const RunSettings& settings_;
    Renderer renderer_;
    Camera camera_;
    std::vector<int> meshes_;  // of the bodies' surfaces, and those that nothing moves
    std::vector<Look> looks_;
    std::vector<std::vector<uvec2>> springs_;
    std::vector<Shape> shapes_;             // one a collider
    std::vector<vec3> drag_points_;         // where each drag pulls from and to
    std::vector<uvec2> drag_lines_;         // between those
    std::vector<Shape> shafts_;             // one a tool
    std::vector<std::vector<Dent>> dents_;  // one list a surface
    std::unique_ptr<Film> film_;
    double next_image_ = 0;
};

}  // namespace palpate
