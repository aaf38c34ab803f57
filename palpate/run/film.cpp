#include "palpate/run/film.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <iterator>
#include <sstream>

namespace palpate {
namespace {

// H.264 halves the resolution of colour, which needs even sides: an odd last row or column is cropped.
std::vector<std::string> command(const std::filesystem::path& path, int width, int height, int rate) {
    // -xerror: without it, ffmpeg reports success when the disk is full.
    std::istringstream text(
        fmt::format("ffmpeg -v error -xerror -y "
                    "-f rawvideo -pix_fmt rgba -s {}x{} -r {} -i - "
                    "-vf crop=trunc(iw/2)*2:trunc(ih/2)*2 "
                    "-c:v libx264 -preset veryfast -crf 20 -pix_fmt yuv420p "
                    "-f mp4 -movflags +faststart",
                    width, height, rate));
    std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
    words.push_back("file:" + path.string());  // so that no name looks like an option
    return words;
}

}  // namespace

void check_film(const std::filesystem::path& path, int width, int height) {
    constexpr int least = 16;  // pixels: a block of H.264
    check_output(path, ".mp4");
    if (width < least || height < least)
        throw Error(fmt::format("pictures of {} x {} pixels are too small for a film", width, height),
                    path.string(), fmt::format("make them {0} x {0} or larger (--size {0}x{0})", least));
    if (!has_program("ffmpeg"))
        throw Error("cannot write a film without the program ffmpeg", path.string(),
                    "install ffmpeg, or ask for --images instead");
}

namespace {

const std::filesystem::path& checked(const std::filesystem::path& path, int width, int height) {
    check_film(path, width, height);
    return path;
}

}  // namespace

Film::Film(const std::filesystem::path& path, int width, int height, int frames_per_second)
    : file_(checked(path, width, height)), ffmpeg_(command(file_.name(), width, height, frames_per_second)) {}

void Film::add(const Image& image) { ffmpeg_.write(image.pixels.data(), image.pixels.size()); }

void Film::finish() {
    ffmpeg_.finish();
    file_.finish();
}

}  // namespace palpate
