#pragma once
#include "palpate/render/renderer.h"
#include "palpate/run/film.h"
#include "palpate/run/play.h"
#include "palpate/run/run.h"
#include "palpate/run/scenery.h"

#include <memory>
#include <set>
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

    /// At time 0 it is the state before the first step. Returns whether it drew; the seconds go to what took
    /// them.
    bool frame_done(double time, const Play& play, Report::Seconds& seconds);

    /// After the last frame.
    void finish();

    /// Names of the pictures in the folder.
    const std::set<std::string>& written() const { return written_; }

 private:
    const std::string name_;
    const RunSettings& settings_;
    Renderer renderer_;
    Scenery scenery_;
    const Camera camera_;
    std::unique_ptr<Film> film_;
    double next_image_ = 0, next_in_film_ = 0;  // s
    std::set<std::string> written_;
};

}  // namespace palpate
