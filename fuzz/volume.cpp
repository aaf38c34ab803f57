// Any bytes as a volume of the format PALPATE_FORMAT: an Error, or a valid volume. For DICOM they are one
// of two files; the other is the slice PALPATE_BESIDE.
#include "palpate/base/error.h"
#include "palpate/files/read.h"
#include "palpate/mesh/histogram.h"

#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

using namespace palpate;

void demand(bool truth) {
    if (!truth) std::abort();
}

// In shared memory, a folder for each process.
std::filesystem::path make_folder() {
    const auto folder = std::filesystem::path("/dev/shm") / ("palpate-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
#ifdef PALPATE_BESIDE
    std::filesystem::copy_file(PALPATE_BESIDE, folder / "beside",
                               std::filesystem::copy_options::overwrite_existing);
#endif
    return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::filesystem::path folder = make_folder();
    const std::string format = PALPATE_FORMAT;
    const auto file = folder / ("fuzz" + format);
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
    try {
        const Volume volume = read_volume(format == ".dcm" ? folder : file);
        demand(volume.count() > 0 && volume.values.size() == volume.count());
        for (float value : volume.values) demand(std::isfinite(value));
        for (int axis = 0; axis < 3; ++axis) {
            demand(volume.spacing[axis] > 0 && std::isfinite(volume.spacing[axis]));
            demand(std::isfinite(volume.origin[axis]));
        }
        demand(std::abs(std::abs(glm::determinant(volume.direction)) - 1) < 0.01f);
        const auto iso = suggested_iso(histogram(volume));
        demand(!iso || std::isfinite(*iso));
    } catch (const Error& error) {
        demand(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
    }
    return 0;
}
