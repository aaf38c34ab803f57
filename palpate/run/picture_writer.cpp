#include "palpate/run/picture_writer.h"

#include "palpate/base/clock.h"
#include "palpate/base/files.h"
#include "palpate/files/image_file.h"
#include "palpate/gl/context.h"
#include "palpate/run/framing.h"

#include <fmt/format.h>

namespace palpate {
namespace {

constexpr int pictures_per_second = 30;  // of a film

}  // namespace

PictureWriter::PictureWriter(const Scene& scene, const Models& made, const RunSettings& settings,
                             const gl::Context* context)
    : name_(scene.name),
      settings_(settings),
      renderer_({settings.width, settings.height}, context),
      scenery_(scene, made, renderer_),
      camera_(camera_of(scene, made, float(settings.width) / float(settings.height))) {
    if (!settings.video.empty())
        film_ = std::make_unique<Film>(settings.video, settings.width, settings.height, pictures_per_second);
}

const std::string& PictureWriter::renderer() const { return renderer_.context().renderer(); }

bool PictureWriter::frame_done(double time, const Play& play, Report::Seconds& seconds) {
    const bool film_wants = film_ && time >= next_in_film_ - 1e-9;
    const bool images_want = !settings_.images.empty() && time >= next_image_ - 1e-9;
    if (!film_wants && !images_want) return false;
    Image image;
    {
        Timed timed(seconds.render);
        renderer_.draw(scenery_.picture(time, play, camera_, settings_.lattice));
        image = renderer_.image();
    }
    Timed timed(seconds.write);
    for (; film_wants && time >= next_in_film_ - 1e-9; next_in_film_ += 1.0 / pictures_per_second)
        film_->add(image);  // several times, if frames are longer than that
    if (images_want) {
        const std::string name = fmt::format("{}-{:05.2f}s.png", name_, time);
        write_png(image, settings_.images / name);
        written_.insert(name);
        next_image_ += settings_.image_every;
    }
    return true;
}

void PictureWriter::finish() {
    if (film_) film_->finish();
}

}  // namespace palpate
