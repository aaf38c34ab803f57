#pragma once
#include "palpate/render/renderer.h"
#include "palpate/run/film.h"
#include "palpate/run/play.h"
#include "palpate/run/run.h"
#include "palpate/run/scenery.h"

#include <memory>
#include <string>

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
    const std::string name_;
    const RunSettings& settings_;
    Renderer renderer_;
    Scenery scenery_;
    const Camera camera_;
    std::unique_ptr<Film> film_;
    double next_image_ = 0;
};

}  // namespace palpate
