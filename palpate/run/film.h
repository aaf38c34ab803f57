#pragma once
#include "palpate/base/pipe.h"
#include "palpate/mesh/image.h"

#include <filesystem>
#include <memory>

namespace palpate {

/// An MP4 film written through the program ffmpeg. It takes its final name when finish() is called; without
/// that nothing is left behind.
class Film {
 public:
    /// Throws Error if ffmpeg is not installed.
    Film(const std::filesystem::path& path, int width, int height, int frames_per_second);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    void add(const Image& image);
    void finish();

 private:
    std::filesystem::path path_, unfinished_;
    std::unique_ptr<Pipe> ffmpeg_;
};

}  // namespace palpate
