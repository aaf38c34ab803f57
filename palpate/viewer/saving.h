#pragma once
#include "palpate/run/experiment.h"
#include "palpate/run/film.h"
#include "palpate/viewer/message.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace palpate {

/// What a person may write of an experiment.
enum class Output { scene, picture, film, surface, recording };

/// Writes that under names that nothing has yet, and says which.
class Saving {
 public:
    explicit Saving(Message& message) : message_(message) {}
    ~Saving();

    /// Into a folder; a scene beside the one that it came from, since it names files from there. A film
    /// begins so, or ends. Throws Error.
    void save(Output what, const Experiment& experiment, const std::filesystem::path& folder,
              const std::function<Image()>& picture);

    bool is_filming() const { return bool(film_); }
    /// After each frame of the scene: films a picture where one is due. All are as large as the first.
    void frame_done(const std::function<Image()>& picture);

 private:
    void begin_film(const std::filesystem::path& name, const Image& first);
    void end_film();

    Message& message_;
    std::unique_ptr<Film> film_;
    std::filesystem::path film_name_;
    ivec2 film_size_ = ivec2(0);
    long frames_ = 0;  // of the scene since the film began
};

}  // namespace palpate
