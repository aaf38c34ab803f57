#include "palpate/base/error.h"
#include "palpate/files/extension.h"
#include "palpate/files/formats/foreign.h"
#include "palpate/files/formats/units.h"
#include "palpate/files/formats/volumes.h"
#include "palpate/files/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <new>
#include <string>
#include <utility>

namespace palpate {

void refuse(std::string_view what, const std::filesystem::path& path, std::string_view remedy) {
    throw Error(what, path.string(), remedy);
}

std::string lower_case(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string lower_name(const std::filesystem::path& path) { return lower_case(path.filename().string()); }

ivec3 checked_sizes(const std::vector<double>& sizes, const std::filesystem::path& path) {
    if (sizes.size() != 3)
        refuse(fmt::format("{} dimensions instead of three", sizes.size()), path,
               "give a volume of one number a voxel");
    for (double size : sizes)
        if (!(size >= 1 && (size == std::floor(size) || !std::isfinite(size))))
            refuse(fmt::format("a volume {} voxels wide", size), path);
    if (!(sizes[0] * sizes[1] * sizes[2] <= most_voxels))
        refuse(fmt::format("{} x {} x {} voxels, more than 2^30", sizes[0], sizes[1], sizes[2]), path,
               "crop or shrink it");
    return {int(sizes[0]), int(sizes[1]), int(sizes[2])};
}

void refuse_truncated(double there, double promised, std::string_view what,
                      const std::filesystem::path& path) {
    refuse(fmt::format("only {:.0f} {} of voxels instead of {:.0f} (it is truncated)", there, what, promised),
           path, "get the file again");
}

namespace {

// False for numbers that no scanner writes.
bool sensible(double number) { return std::abs(number) < 1e9; }

// Why steps and an origin are not a valid grid; empty if they are.
std::string trouble(const dmat3& steps, dvec3 origin) {
    for (int i = 0; i < 3; ++i) {
        const double width = glm::length(steps[i]);
        if (!(width > 1e-9 && sensible(width))) return fmt::format("voxels {} wide", width);
        if (!sensible(origin[i])) return "an origin that is not finite";
        for (int j = 0; j < i; ++j)
            if (!(std::abs(glm::dot(steps[i], steps[j])) <= 1e-3 * width * glm::length(steps[j])))
                return "axes that are not at right angles";
    }
    return {};
}

}  // namespace

std::optional<Grid> grid_of(ivec3 dims, const dmat3& steps, dvec3 origin) {
    if (!trouble(steps, origin).empty()) return std::nullopt;
    Grid grid{.dims = dims, .origin = origin};
    for (int i = 0; i < 3; ++i) {
        grid.spacing[i] = glm::length(steps[i]);
        grid.direction[i] = steps[i] / grid.spacing[i];
    }
    return grid;
}

Grid checked_grid(ivec3 dims, const dmat3& steps, dvec3 origin, const std::filesystem::path& path) {
    if (const auto grid = grid_of(dims, steps, origin)) return *grid;
    const std::string what = trouble(steps, origin);
    refuse(what, path, what.starts_with("axes") ? "resample it to axes at right angles" : "export it again");
}

double named_unit(const std::string& name, std::vector<std::string>& notes) {
    if (const auto metres = metres_of(name)) return *metres;
    if (!name.empty() && name != "?" && name != "???" && name != "none" && name != "unknown")
        notes.push_back("its unit of length, \"" + name + "\", is unknown: millimetres are assumed");
    return 0;
}

namespace {

struct Format {
    const char* extension;
    Reading (*read)(const std::filesystem::path&);
};
constexpr Format formats[] = {
    {".nii", read_nifti}, {".hdr", read_nifti},     {".img", read_nifti},     {".nrrd", read_nrrd},
    {".nhdr", read_nrrd}, {".mha", read_metaimage}, {".mhd", read_metaimage},
};

// By the file name's extension, ignoring a final .gz.
const Format* format_of(const std::filesystem::path& path) {
    std::string name = lower_name(path);
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    for (const Format& format : formats)
        if (name.ends_with(format.extension)) return &format;
    return nullptr;
}

Reading read_anywhere(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    if (std::error_code unreadable; std::filesystem::is_regular_file(path, unreadable)) {
        std::string first(500, ' ');
        std::ifstream(path, std::ios::binary).read(first.data(), std::streamsize(first.size()));
        if (std::filesystem::file_size(path, unreadable) == 0)
            refuse("an empty file", path, "get the file again");
        refuse_foreign(first, path.string());
    }
    if (format && std::filesystem::is_directory(path))
        refuse("a folder where a file was expected", path, "name a file");
    if (format) return format->read(path);
    if (is_volume(path)) return read_dicom(path);
    refuse("cannot read the volume format \"" + extension(path) + "\"", path,
           "use .nii, .hdr and .img, .nrrd, .nhdr, .mha, .mhd or a folder with a DICOM series");
}

// Voxels without a value count as outside: they get the lowest value, at most 0.
void fill_outside(Reading& reading, const std::filesystem::path& path) {
    float lowest = 0;
    std::size_t without = 0;
    for (float value : reading.values) {
        if (std::isfinite(value))
            lowest = std::min(lowest, value);
        else
            ++without;
    }
    if (without == 0) return;
    if (without == reading.values.size()) refuse("no voxel with a finite value", path, "give another file");
    for (float& value : reading.values)
        if (!std::isfinite(value)) value = lowest;
    reading.notes.push_back(
        fmt::format("{} voxels ({:.2g} %) have no value (NaN, infinite, or marked as outside): they get {}",
                    without, 100.0 * double(without) / double(reading.values.size()), lowest));
}

std::string name_of_unit(double unit) {
    for (const auto& [length, name] :
         {std::pair(1.0, "m"), {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}, {1e-9, "nm"}})
        if (unit == length) return name;
    return fmt::format("units of {} m", unit);
}

double unit_for(const std::optional<Units>& given, Reading& reading) {
    const double stated = reading.unit;
    if (!given) return stated > 0 ? stated : 1e-3;
    const double unit = double(metres(*given));
    if (stated > 0 && std::abs(unit / stated - 1) > 1e-6)
        reading.notes.push_back(
            fmt::format("its lengths are in {}, as it says, but are taken in {}, as was "
                        "asked for",
                        name_of_unit(stated), name_of(*given)));
    return unit;
}

}  // namespace

bool is_volume(const std::filesystem::path& path) {
    std::error_code unreadable;
    return format_of(path) || extension(path) == ".dcm" || is_dicom(path) ||
           std::filesystem::is_directory(path, unreadable);
}

Volume read_volume(const std::filesystem::path& path, std::optional<Units> units,
                   std::vector<std::string>* notes) {
    try {
        Reading reading = read_anywhere(path);
        fill_outside(reading, path);
        const double unit = unit_for(units, reading);
        if (notes) notes->insert(notes->end(), reading.notes.begin(), reading.notes.end());
        return {.name = path.string(),
                .dims = reading.grid.dims,
                .spacing = reading.grid.spacing * unit,
                .origin = reading.grid.origin * unit,
                .direction = reading.grid.direction,
                .values = std::move(reading.values)};
    } catch (const std::filesystem::filesystem_error& error) {
        refuse("cannot read (" + error.code().message() + ")", path,
               "check the name and that it may be read");
    } catch (const std::bad_alloc&) {
        refuse("more than the memory can hold", path, "crop or shrink it");
    }
}

}  // namespace palpate
