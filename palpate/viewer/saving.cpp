#include "palpate/viewer/saving.h"

#include "palpate/base/files.h"
#include "palpate/files/image_file.h"
#include "palpate/files/write.h"
#include "palpate/viewer/session.h"

#include <fmt/format.h>

namespace palpate {
namespace {

constexpr long frames_per_picture = 2;  // of a film: 30 pictures a second

// The first numbered name that is free.
std::filesystem::path free_name(const Experiment& experiment, const std::filesystem::path& folder,
                                const std::string& extension) {
    const std::string stem = std::filesystem::path(experiment.source().name).stem().string();
    std::error_code error;
    for (int number = 1;; ++number) {
        const std::filesystem::path name = folder / fmt::format("{}-{}{}", stem, number, extension);
        if (!std::filesystem::exists(name, error)) return name;
    }
}

std::string text_of(const Experiment& experiment) {
    experiment.require_text();
    std::vector<Change> changes = experiment.changes();
    std::erase(changes, all_cores());  // a setting of this machine, not of the scene
    return changed(experiment.source(), changes);
}

}  // namespace

Saving::~Saving() {
    message_.attempt([&] { end_film(); });
}

void Saving::save(Output what, const Experiment& experiment, const std::filesystem::path& folder,
                  const std::function<Image()>& picture) {
    auto name = [&](const std::string& extension) {
        return free_name(experiment, folder, extension).string();
    };
    if (what == Output::film) {
        film_ ? end_film() : begin_film(name(".mp4"), picture());
    } else if (what == Output::scene) {
        const std::filesystem::path file = free_name(experiment, experiment.source().folder, ".toml");
        write_text(file, text_of(experiment));
        message_.say("saved the scene as " + file.lexically_normal().string());
    } else if (what == Output::picture) {
        const std::string file = name(".png");
        write_png(picture(), file);
        message_.say("saved a picture as " + file);
    } else if (what == Output::recording) {
        const std::string file = name(".json");
        write_recording(experiment.recording(), file);
        message_.say("saved all inputs since the beginning as " + file + "; drop it here to replay it");
    } else {
        std::vector<std::string> files;
        for (const Skin& skin : experiment.play().skins()) {
            files.push_back(name(".ply"));
            write_mesh({skin.positions, skin.normals, *skin.triangles}, files.back());
        }
        message_.say(fmt::format("saved the surface as {}", fmt::join(files, ", ")));
    }
}

void Saving::begin_film(const std::filesystem::path& name, const Image& first) {
    auto film = std::make_unique<Film>(name, first.width, first.height, 60 / int(frames_per_picture));
    film->add(first);
    film_ = std::move(film);
    film_name_ = name;
    film_size_ = {first.width, first.height};
    frames_ = 0;
    message_.say("filming; V again ends it");
}

void Saving::end_film() {
    if (!film_) return;
    const std::unique_ptr<Film> film = std::move(film_);
    film->finish();
    message_.say("saved the film as " + film_name_.string());
}

void Saving::frame_done(const std::function<Image()>& picture) {
    if (!film_ || ++frames_ % frames_per_picture != 0) return;
    const bool done = message_.attempt([&] {
        const Image next = picture();
        if (ivec2(next.width, next.height) == film_size_) return film_->add(next);
        end_film();
        message_.say(
            "the film ended where the picture got another size, and is saved as " + film_name_.string(),
            true);
    });
    if (!done) film_.reset();
}

}  // namespace palpate
