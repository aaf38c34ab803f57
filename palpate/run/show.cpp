#include "palpate/run/show.h"

#include "palpate/base/clock.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"

#include <fmt/format.h>

namespace palpate {
namespace {

constexpr int frames_per_picture = 2;  // of a film: 30 pictures a second

}  // namespace

Show::Show(const Scene& scene, const Models& made, const RunSettings& settings, const gl::Context* context)
    : name_(scene.name),
      settings_(settings),
      renderer_({settings.width, settings.height}, context),
      scenery_(scene, made, renderer_),
      camera_(camera_of(scene, made)) {
    if (!settings.video.empty())
        film_ =
            std::make_unique<Film>(settings.video, settings.width, settings.height, 60 / frames_per_picture);
    if (!settings.images.empty()) make_folder(settings.images);
}

const std::string& Show::renderer() const { return renderer_.context().renderer(); }

bool Show::frame_done(int number, const Play& play, Report::Seconds& seconds) {
    const double time = number * frame_seconds;
    const bool film_wants = film_ && number % frames_per_picture == 0;
    const bool images_want = !settings_.images.empty() && time >= next_image_ - 1e-9;
    if (!film_wants && !images_want) return false;
    Image image;
    {
        Timed timed(seconds.render);
        renderer_.draw(scenery_.picture(time, play, camera_, settings_.lattice));
        image = renderer_.image();
    }
    Timed timed(seconds.write);
    if (film_wants) film_->add(image);
    if (images_want) {
        write_png(image, settings_.images / fmt::format("{}-{:05.2f}s.png", name_, time));
        next_image_ += settings_.image_every;
    }
    return true;
}

void Show::finish() {
    if (film_) film_->finish();
}

}  // namespace palpate
