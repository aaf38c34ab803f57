#pragma once
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/mesh/image.h"

#include <filesystem>

namespace palpate {

/// Throws Error if no film can be written there: without ffmpeg, or under a name that ends otherwise than
/// ".mp4".
void check_film(const std::filesystem::path& path);

/// An MP4 film written through the program ffmpeg. It takes its final name when finish() is called; without
/// that nothing is left behind.
class Film {
 public:
    /// Throws Error as check_film does.
    Film(const std::filesystem::path& path, int width, int height, int frames_per_second);

    void add(const Image& image);
    void finish();

 private:
    Unfinished file_;
    Pipe ffmpeg_;  // ends before its file goes
};

}  // namespace palpate
