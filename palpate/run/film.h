#pragma once
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/mesh/image.h"

#include <filesystem>

namespace palpate {

/// Throws Error if no film of so many pixels can be written there: without ffmpeg, under a name that does not
/// end in ".mp4", or if it is smaller than 16 x 16.
void check_film(const std::filesystem::path& path, int width, int height);

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
