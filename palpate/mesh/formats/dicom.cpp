#include "palpate/mesh/formats/volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <system_error>

namespace palpate {
namespace {

// Of lengths, relative to the distance of two slices; of directions.
constexpr double uneven = 0.01, askew = 1e-3;

bool has_mark(const std::filesystem::path& file) {
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(file, unreadable)) return false;
    char start[132]{};
    std::ifstream(file, std::ios::binary).read(start, sizeof start);
    return std::memcmp(start + 128, "DICM", 4) == 0;
}

std::string name(const Slice& slice) { return slice.file.filename().string(); }

// A series, as a list of several tells of it.
std::string summary(const std::vector<Slice>& slices) {
    const std::string& description = slices[0].description;
    return fmt::format("{} ({} slices{})", name(slices[0]), slices.size(),
                       description.empty() ? "" : ", " + description);
}

void check_alike(const Slice& a, const Slice& b, const std::filesystem::path& path) {
    auto differ = [&](const char* what) {
        refuse(fmt::format("slices of different {}, {} and {},", what, name(a), name(b)), path,
               "export each series into a folder of its own");
    };
    if (a.grid.dims != b.grid.dims) differ("sizes");
    for (int axis = 0; axis < 2; ++axis) {
        if (!(std::abs(a.grid.spacing[axis] - b.grid.spacing[axis]) <= askew * a.grid.spacing[axis]))
            differ("spacings");
        if (!(glm::distance(a.grid.direction[axis], b.grid.direction[axis]) <= askew)) differ("directions");
    }
}

// Each slice's distance to the next.
void check_even(const std::vector<Slice>& slices, const std::vector<double>& steps,
                const std::filesystem::path& path) {
    auto between = [&](std::size_t i) { return name(slices[i]) + " and " + name(slices[i + 1]); };
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (!(steps[i] > uneven * std::max(usual, 1e-6)))
            refuse("two slices at the same place, " + between(i) + ",", path, "export one volume alone");
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (!(std::abs(steps[i] - usual) <= uneven * usual))
            refuse(fmt::format("a distance of {:.6g} mm between {} where others have {:.6g} mm (slices are "
                               "missing)",
                               steps[i], between(i), usual),
                   path, "add the missing files, or export it with even distances");
}

void check_straight(const std::vector<Slice>& slices, double spacing, const std::filesystem::path& path) {
    const dvec3 up = slices[0].grid.direction[2];
    for (const Slice& slice : slices) {
        const dvec3 way = slice.grid.origin - slices[0].grid.origin;
        const double along = glm::dot(way, up), sideways = glm::length(way - along * up);
        if (!(sideways <= uneven * spacing + askew * along))
            refuse(fmt::format("slices that shift sideways by {:.3g} mm at {} (a tilted gantry)", sideways,
                               name(slice)),
                   path, "resample it to axes at right angles, as 3D Slicer or dcm2niix do");
    }
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (!std::filesystem::is_directory(path, unreadable)) return has_mark(path);
    return std::any_of(std::filesystem::directory_iterator(path, unreadable), {},
                       [](const auto& entry) { return has_mark(entry.path()); });
}

std::vector<std::filesystem::path> dicom_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (has_mark(entry.path())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<Slice> one_series(const std::vector<Slice>& slices, const std::filesystem::path& path) {
    std::map<std::string, std::vector<Slice>> all;
    for (const Slice& slice : slices) all[slice.series].push_back(slice);
    for (const Slice& slice : slices)
        if (slice.file.filename() == path.filename()) return all[slice.series];

    if (!std::filesystem::is_directory(path)) refuse("no DICOM slice", path, "name another file");

    std::erase_if(all, [](const auto& series) { return series.second.size() < 2; });
    if (all.empty()) refuse("no DICOM series of more than one slice", path, "name another folder");
    if (all.size() == 1) return all.begin()->second;
    std::string list;
    for (const auto& [uid, series] : all) list += (list.empty() ? "" : ", ") + summary(series);
    refuse(fmt::format("{} DICOM series", all.size()), path, "name one file of the series you want: " + list);
}

Grid stack(std::vector<Slice>& slices, const std::filesystem::path& path) {
    if (slices.size() < 2) refuse("a single slice", path, "give a series");
    for (const Slice& slice : slices) check_alike(slices[0], slice, path);
    Grid grid = slices[0].grid;
    auto height = [up = grid.direction[2]](const Slice& slice) { return glm::dot(slice.grid.origin, up); };
    std::stable_sort(slices.begin(), slices.end(),
                     [&](const Slice& a, const Slice& b) { return height(a) < height(b); });
    std::vector<double> steps;
    for (std::size_t i = 1; i < slices.size(); ++i)
        steps.push_back(height(slices[i]) - height(slices[i - 1]));
    check_even(slices, steps, path);

    grid.dims.z = int(slices.size());
    check_sizes({double(grid.dims.x), double(grid.dims.y), double(grid.dims.z)}, path);
    grid.origin = slices[0].grid.origin;
    grid.spacing.z = (height(slices.back()) - height(slices[0])) / double(steps.size());
    check_straight(slices, grid.spacing.z, path);
    return grid;
}

}  // namespace palpate
