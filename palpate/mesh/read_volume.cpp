#include "palpate/base/error.h"
#include "palpate/mesh/ending.h"
#include "palpate/mesh/formats/volumes.h"
#include "palpate/mesh/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

namespace palpate {

void refuse(std::string_view what, const std::filesystem::path& path, std::string_view remedy) {
    throw Error(what, path.string(), remedy);
}

void check_sizes(const std::vector<double>& sizes, const std::filesystem::path& path) {
    if (sizes.size() != 3)
        refuse(fmt::format("{} dimensions instead of three", sizes.size()), path,
               "give a volume of one number a voxel");
    for (double size : sizes)
        if (!(size >= 1)) refuse(fmt::format("a volume {} voxels wide", size), path);
    if (!(sizes[0] * sizes[1] * sizes[2] <= most_voxels))
        refuse(fmt::format("{} x {} x {} voxels, more than 2^30", sizes[0], sizes[1], sizes[2]), path,
               "crop or shrink it");
}

void refuse_truncated(double there, double promised, const std::filesystem::path& path) {
    refuse(fmt::format("{:.0f} bytes of voxels where {:.0f} are promised (it is truncated)", there, promised),
           path, "get the file again");
}

namespace {

struct Format {
    const char* ending;
    Found (*look_through)(const std::filesystem::path&);
};
constexpr Format formats[] = {
    {".nii", look_through_nifti}, {".nii.gz", look_through_nifti},  {".nrrd", look_through_nrrd},
    {".nhdr", look_through_nrrd}, {".mha", look_through_metaimage}, {".mhd", look_through_metaimage},
};

const Format* format_of(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    for (const Format& format : formats)
        if (name.ends_with(format.ending)) return &format;
    return nullptr;
}

Volume read_anywhere(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    if (format && std::filesystem::is_directory(path))
        refuse("a folder where a file was expected", path, "name a file");
    if (format) return read_with_itk(path, format->look_through(path));
    if (is_volume(path)) return read_dicom(path);
    if (std::filesystem::is_directory(path)) refuse("no DICOM file", path, "name another folder");
    refuse("cannot read the volume format \"" + ending(path) + "\"", path,
           "use .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or a folder with a DICOM series");
}

void check_values(const Volume& volume, const std::filesystem::path& path) {
    const auto bad = std::find_if_not(volume.values.begin(), volume.values.end(),
                                      [](float value) { return std::isfinite(value); });
    if (bad != volume.values.end())
        refuse(fmt::format("voxel {} is not finite", bad - volume.values.begin()), path);
}

}  // namespace

bool is_volume(const std::filesystem::path& path) {
    return format_of(path) || path.extension() == ".dcm" || is_dicom(path);
}

Volume read_volume(const std::filesystem::path& path, Units units) {
    try {
        Volume volume = read_anywhere(path);
        check_values(volume, path);
        volume.name = path.string();
        volume.spacing *= metres(units);
        volume.origin *= metres(units);
        return volume;
    } catch (const std::filesystem::filesystem_error& error) {
        refuse("cannot read (" + error.code().message() + ")", path,
               "check the name and that it may be read");
    } catch (const std::bad_alloc&) {
        refuse("more than the memory can hold", path, "crop or shrink it");
    }
}

}  // namespace palpate
