#pragma once
#include "palpate/run/experiment.h"
#include "palpate/run/film.h"
#include "palpate/viewer/message.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace palpate {

/// What can be saved of an experiment.
enum class Output { scene, picture, film, surface, recording };

/// Saves outputs under new names, and says which.
class Saving {
 public:
    explicit Saving(Message& message) : message_(message) {}
    ~Saving();

    /// Saves into a folder; a scene goes beside the original one, because its file names are relative to
    /// that. A film begins or ends. Throws Error.
    void save(Output what, const Experiment& experiment, const std::filesystem::path& folder,
              const std::function<Image()>& picture);

    bool is_filming() const { return bool(film_); }
    /// To be called after each frame of the scene: films a picture if one is due. All have the size of the
    /// first.
    void frame_done(const std::function<Image()>& picture);

 private:
    void begin_film(const std::filesystem::path& name, const Image& first);
    void end_film();

    Message& message_;
    std::unique_ptr<Film> film_;
    std::filesystem::path film_name_;
    ivec2 film_size_ = ivec2(0);
    long frames_ = 0;  // frames of the scene since the film began
};

}  // namespace palpate
