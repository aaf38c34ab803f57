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

/// Draws a moving scene into a film and single pictures.
class PictureWriter {
 public:
    /// `context`: that of a backend on the GPU, if there is one.
    PictureWriter(const Scene& scene, const Models& made, const RunSettings& settings,
                  const gl::Context* context = nullptr);

    /// The OpenGL driver.
    const std::string& renderer() const;

    /// Draws if a picture is due. At time 0 it is the state before the first step. Returns whether it drew;
    /// adds the time to `seconds`.
    bool frame_done(double time, const Play& play, Report::Seconds& seconds);

    /// Must be called after the last frame.
    void finish();

    /// The names of the pictures that were written into the folder.
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
