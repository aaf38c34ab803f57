#pragma once
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/mesh/image.h"

#include <filesystem>

namespace palpate {

/// Throws Error if a film of that size cannot be written there: without ffmpeg, if the name does not end in
/// ".mp4", or if it is smaller than 16 x 16.
void check_film(const std::filesystem::path& path, int width, int height);

/// An MP4 film, encoded by the program ffmpeg. It gets its final name in finish(), and is removed without
/// that.
class Film {
 public:
    /// Throws Error as check_film does.
    Film(const std::filesystem::path& path, int width, int height, int frames_per_second);

    void add(const Image& image);
    void finish();

 private:
    Unfinished file_;
    Pipe ffmpeg_;  // is destroyed before the file
};

}  // namespace palpate
