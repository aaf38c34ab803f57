#include "palpate/files/formats/dicom.h"

#include "palpate/base/error.h"
#include "palpate/files/formats/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <system_error>

namespace palpate {
namespace {

using Group = std::vector<Slice>;

// How unevenly slices may be spaced: silently, and with a note. In slice distances.
constexpr double even = 0.01, bearable = 0.1;
// The tolerance of directions, and of relative spacings.
constexpr double alike = 1e-3;
constexpr int most_files_in_a_folder = 100'000, deepest = 8;

// ---- files ----

// A data set without the DICM prefix begins with a tag of group 2 or 8, in either byte order, and a value
// representation or a length.
bool begins_bare(const char* start) {
    const auto byte = [&](int i) { return static_cast<unsigned char>(start[i]); };
    const bool group = (byte(0) == 8 || byte(0) == 2) && byte(1) == 0 && byte(3) == 0 && byte(2) < 0x20;
    const bool turned = byte(0) == 0 && (byte(1) == 8 || byte(1) == 2) && byte(2) == 0 && byte(3) < 0x20;
    const bool kind = std::isupper(byte(4)) && std::isupper(byte(5));
    const bool length = byte(4) < 128 && byte(5) == 0 && byte(6) == 0 && byte(7) == 0;
    return (group && (kind || length)) || (turned && kind);
}

bool holds_dicom(const std::filesystem::path& file) {
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(file, unreadable)) return false;
    char start[132]{};
    std::ifstream(file, std::ios::binary).read(start, sizeof start);
    return std::memcmp(start + 128, "DICM", 4) == 0 || begins_bare(start);
}

std::vector<std::filesystem::path> dicom_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (holds_dicom(entry.path())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Files in folders below.
std::vector<std::filesystem::path> dicom_files_below(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    int seen = 0;
    const auto options = std::filesystem::directory_options::skip_permission_denied;
    for (std::filesystem::recursive_directory_iterator entry(folder, options), end; entry != end; ++entry) {
        if (++seen > most_files_in_a_folder)
            refuse(fmt::format("more than {} files", most_files_in_a_folder), folder,
                   "name the folder of one series");
        if (entry.depth() >= deepest) entry.disable_recursion_pending();
        if (entry.depth() > 0 && holds_dicom(entry->path())) files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

// ---- one series ----

std::string name(const Slice& slice) { return slice.file.filename().string(); }

// Groups of slices that are alike, in the order of their first slices.
template <class Alike>
std::vector<Group> grouped(const Group& slices, Alike are_alike) {
    std::vector<Group> groups;
    for (const Slice& slice : slices) {
        const auto group = std::find_if(groups.begin(), groups.end(),
                                        [&](const Group& g) { return are_alike(g[0], slice); });
        if (group == groups.end())
            groups.push_back({slice});
        else
            group->push_back(slice);
    }
    return groups;
}

// The largest group; if a file is named, the largest with a slice of that file.
const Group& taken_of(const std::vector<Group>& groups, const std::filesystem::path& named) {
    const auto worth = [&](const Group& group) {
        const bool holds = std::ranges::any_of(group, [&](const Slice& s) { return s.file == named; });
        return std::pair(holds, group.size());
    };
    return *std::ranges::max_element(groups, {}, worth);
}

bool same_size(const Slice& a, const Slice& b) { return a.size == b.size; }
bool same_angle(const Slice& a, const Slice& b) {
    if (!a.direction || !b.direction) return a.direction.has_value() == b.direction.has_value();
    return glm::distance((*a.direction)[0], (*b.direction)[0]) <= alike &&
           glm::distance((*a.direction)[1], (*b.direction)[1]) <= alike;
}
bool same_spacing(const Slice& a, const Slice& b) {
    return glm::all(glm::lessThanEqual(glm::abs(a.spacing - b.spacing), alike * a.spacing));
}
bool same_shape(const Slice& a, const Slice& b) {
    return same_size(a, b) && same_angle(a, b) && same_spacing(a, b) &&
           a.position.has_value() == b.position.has_value();
}

std::string difference(const Slice& a, const Slice& b) {
    if (!same_size(a, b)) return "of another size";
    if (!same_angle(a, b)) return "at another angle";
    if (!same_spacing(a, b)) return "of another spacing";
    return b.position ? "with a position" : "without a position";
}

// A series in one line, for a list.
std::string summary(const Group& slices, const std::filesystem::path& path) {
    const std::string& description = slices[0].description;
    return fmt::format("{} ({} slices{})", slices[0].file.lexically_relative(path).string(), slices.size(),
                       description.empty() ? "" : ", " + description);
}

// Files that are not slices, grouped by the reason.
std::map<std::string, Group> by_trouble(const Group& all) {
    std::map<std::string, Group> troubles;
    for (const Slice& slice : all)
        if (!slice.trouble.empty()) troubles[slice.trouble].push_back(slice);
    return troubles;
}

[[noreturn]] void refuse_slice(const Slice& slice) { refuse(slice.trouble, slice.file, slice.remedy); }

// If there is no series: the most common reason.
[[noreturn]] void refuse_all(const Group& all, const std::filesystem::path& path) {
    const auto troubles = by_trouble(all);
    if (troubles.empty()) refuse("no DICOM series of more than one slice", path, "name another folder");
    const auto worst =
        std::ranges::max_element(troubles, {}, [](const auto& trouble) { return trouble.second.size(); });
    refuse_slice(worst->second[0]);
}

// Some exporters make every slice a series. So series of one slice each that agree in everything count as one
// volume: all that are like the named one, or the first. Empty if they differ.
Group joined(const std::map<std::string, Group>& singles, const std::filesystem::path& named,
             std::vector<std::string>& notes) {
    Group slices;
    for (const auto& [uid, group] : singles)
        if (group.size() == 1) slices.push_back(group[0]);
    const auto groups = grouped(slices, [](const Slice& a, const Slice& b) {
        return same_shape(a, b) && a.study == b.study && a.description == b.description;
    });
    if (groups.empty() || (named.empty() && groups.size() > 1)) return {};
    const Group& taken = taken_of(groups, named);
    if (taken.size() < 3 || !taken[0].position || !taken[0].direction) return {};
    notes.push_back(fmt::format(
        "{} series of one slice each, alike in study, description and shape: they are taken as one",
        taken.size()));
    return taken;
}

Group one_series(const Group& all, const std::filesystem::path& named, const std::filesystem::path& path,
                 std::vector<std::string>& notes) {
    std::map<std::string, Group> series;
    for (const Slice& slice : all)
        if (slice.trouble.empty()) series[slice.series].push_back(slice);
    if (!named.empty()) {
        const auto slice = std::ranges::find(all, named, &Slice::file);
        if (slice == all.end()) refuse("no DICOM slice", named, "name another file");
        if (!slice->trouble.empty()) refuse_slice(*slice);
        const Group& own = series[slice->series];
        const Group more = own.size() == 1 ? joined(series, named, notes) : Group();
        return more.empty() ? own : more;
    }
    const auto is_single = [](const auto& one) {
        return taken_of(grouped(one.second, same_shape), {}).size() < 2;
    };
    std::map<std::string, Group> singles = series;
    std::erase_if(series, is_single);
    std::erase_if(singles, [&](const auto& one) { return series.contains(one.first); });
    if (series.empty()) {
        const Group one = joined(singles, named, notes);
        if (!one.empty()) return one;
        if (singles.size() > 1)
            refuse(
                fmt::format("{} series of one slice each, which differ in study, description, size, spacing "
                            "or angle,",
                            singles.size()),
                path, "export the slices of one volume as one series");
        refuse_all(all, path);
    }
    if (!singles.empty())
        notes.push_back(fmt::format("{} series of a single slice left out", singles.size()));
    if (series.size() == 1) return series.begin()->second;
    std::string list;
    for (const auto& [uid, slices] : series) list += (list.empty() ? "" : ", ") + summary(slices, path);
    refuse(fmt::format("{} DICOM series", series.size()), path,
           "name one file of the series you want: " + list);
}

void note_troubles(const Group& all, std::vector<std::string>& notes) {
    for (const auto& [trouble, slices] : by_trouble(all))
        notes.push_back(fmt::format("{} left out ({}{}): {}", counted(slices.size(), "file"), name(slices[0]),
                                    slices.size() > 1 ? ", ..." : "", trouble));
}

// If the named file has several slices, it is taken alone.
Group of_one_file(const Group& series, const std::filesystem::path& named, std::vector<std::string>& notes) {
    Group own;
    std::ranges::copy_if(series, std::back_inserter(own), [&](const Slice& s) { return s.file == named; });
    if (own.size() < 2) return series;
    if (own.size() < series.size())
        notes.push_back(fmt::format("{} of the same series left out: in other files",
                                    counted(series.size() - own.size(), "slice")));
    return own;
}

Group of_one_shape(const Group& series, const std::filesystem::path& named, std::vector<std::string>& notes) {
    const std::vector<Group> shapes = grouped(series, same_shape);
    const Group& taken = taken_of(shapes, named);
    for (const Group& other : shapes)
        if (&other != &taken)
            notes.push_back(fmt::format("{} of the same series left out ({}{}): {}",
                                        counted(other.size(), "slice"), name(other[0]),
                                        other.size() > 1 ? ", ..." : "", difference(taken[0], other[0])));
    return taken;
}

// ---- several volumes in one place ----

double height(const Slice& slice) {
    if (slice.position)
        return glm::dot(*slice.position, slice.direction ? (*slice.direction)[2] : dvec3(0, 0, 1));
    return slice.location.value_or(slice.number);
}

// The median distance of neighbouring slices, which are sorted by height.
double usual_step(const Group& slices) {
    const double range = height(slices.back()) - height(slices[0]);
    std::vector<double> steps;
    for (std::size_t i = 1; i < slices.size(); ++i)
        if (const double step = height(slices[i]) - height(slices[i - 1]);
            step > 1e-3 * range / double(slices.size()))
            steps.push_back(step);
    std::sort(steps.begin(), steps.end());
    return steps.empty() ? 0 : steps[steps.size() / 2];
}

// Slices sorted by height, in runs at one place.
std::vector<Group> places(Group slices) {
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) {
        return std::pair(height(a), a.number) < std::pair(height(b), b.number);
    });
    const double near = 0.05 * usual_step(slices);
    std::vector<Group> all;
    for (const Slice& slice : slices) {
        if (all.empty() || height(slice) - height(all.back()[0]) > near) all.emplace_back();
        all.back().push_back(slice);
    }
    return all;
}

std::size_t most_in_a_place(const Group& slices) {
    std::size_t most = 0;
    for (const Group& place : places(slices)) most = std::max(most, place.size());
    return most;
}

// Splits volumes by one or two marks of their slices, if these distinguish all slices at each place.
std::vector<Group> parted(const Group& slices, std::string& by) {
    const std::size_t most = most_in_a_place(slices), marks = slices[0].marks.size();
    auto parted_by = [&](std::size_t i, std::size_t j) {
        std::set<std::pair<std::string, std::string>> kinds;
        for (const Slice& slice : slices) kinds.emplace(slice.marks[i].second, slice.marks[j].second);
        if (kinds.size() < 2 || kinds.size() >= 2 * most) return std::vector<Group>();
        auto volumes = grouped(slices, [&](const Slice& a, const Slice& b) {
            return a.marks[i] == b.marks[i] && a.marks[j] == b.marks[j];
        });
        const bool apart =
            std::ranges::all_of(volumes, [](const Group& volume) { return most_in_a_place(volume) == 1; });
        return apart ? volumes : std::vector<Group>();
    };
    for (std::size_t further = 0; further < marks; ++further)  // one alone first
        for (std::size_t i = 0; i + further < marks; ++i) {
            const std::size_t j = i + further;
            const std::vector<Group> volumes = parted_by(i, j);
            if (volumes.empty()) continue;
            by = slices[0].marks[i].first + (i == j ? "" : " and " + slices[0].marks[j].first);
            return volumes;
        }
    return {};
}

// Whether two files have the same bytes from their pixels on.
bool same_pixels(const Slice& a, const Slice& b) {
    if (a.file == b.file || a.frame != b.frame) return false;
    if (std::filesystem::file_size(a.file) - a.pixels_at != std::filesystem::file_size(b.file) - b.pixels_at)
        return false;
    std::ifstream one(a.file, std::ios::binary), other(b.file, std::ios::binary);
    one.seekg(std::streamoff(a.pixels_at));
    other.seekg(std::streamoff(b.pixels_at));
    return std::equal(std::istreambuf_iterator(one), {}, std::istreambuf_iterator(other));
}

// Removes copies: the same image at the same place.
Group without_copies(const Group& slices, const std::filesystem::path& named,
                     std::vector<std::string>& notes) {
    Group kept;
    std::vector<std::string> copies;
    for (const Group& place : places(slices)) {
        Group here, all = place;
        std::stable_partition(all.begin(), all.end(),
                              [&](const Slice& slice) { return slice.file == named; });
        for (const Slice& slice : all) {
            if (std::ranges::any_of(here, [&](const Slice& other) { return same_pixels(other, slice); }))
                copies.push_back(name(slice));
            else
                here.push_back(slice);
        }
        kept.insert(kept.end(), here.begin(), here.end());
    }
    if (!copies.empty())
        notes.push_back(fmt::format("{} left out ({}{}): copies of others", counted(copies.size(), "file"),
                                    copies[0], copies.size() > 1 ? ", ..." : ""));
    return kept;
}

// The first slice at each place, the second, and so on.
std::vector<Group> in_order(const Group& slices) {
    std::vector<Group> volumes(most_in_a_place(slices));
    for (const Group& place : places(slices))
        for (std::size_t i = 0; i < place.size(); ++i) volumes[i].push_back(place[i]);
    return volumes;
}

Group of_one_time(Group slices, const std::filesystem::path& named, std::vector<std::string>& notes) {
    if (most_in_a_place(slices) == 1) return slices;
    std::string by;
    std::vector<Group> volumes = parted(slices, by);
    if (volumes.empty()) {
        slices = without_copies(slices, named, notes);
        if (most_in_a_place(slices) == 1) return slices;
        volumes = parted(slices, by);
    }
    if (volumes.empty()) {
        by = "the order of their numbers alone";
        volumes = in_order(slices);
    }
    const Group& taken = taken_of(volumes, named);
    notes.push_back(fmt::format(
        "{} volumes in one place, distinguished by {}: {} taken; name a file of another "
        "to read that",
        volumes.size(), by, named.empty() ? "that of " + name(taken[0]) : "the one that was named"));
    return taken;
}

// ---- their grid ----

// Slice i lies at first + i · step.
struct Line {
    double first, step;

    double farthest(const std::vector<double>& heights) const {
        double most = 0;
        for (std::size_t i = 0; i < heights.size(); ++i)
            most = std::max(most, std::abs(heights[i] - first - double(i) * step));
        return most;
    }
};

// A line fit by least squares, unless a step is given; centred between the largest residuals.
Line line_through(const std::vector<double>& heights, double step = 0) {
    const auto count = double(heights.size());
    const double middle = (count - 1) / 2,
                 mean = std::accumulate(heights.begin(), heights.end(), 0.0) / count;
    double above = 0, below = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        above += (double(i) - middle) * (heights[i] - mean);
        below += (double(i) - middle) * (double(i) - middle);
    }
    if (step <= 0) step = above / below;
    double lowest = heights[0], highest = heights[0];
    for (std::size_t i = 0; i < heights.size(); ++i) {
        lowest = std::min(lowest, heights[i] - double(i) * step);
        highest = std::max(highest, heights[i] - double(i) * step);
    }
    return {(lowest + highest) / 2, step};
}

[[noreturn]] void refuse_uneven(const Group& slices, const std::vector<double>& heights,
                                const std::filesystem::path& path) {
    std::vector<double> steps(heights.size() - 1);
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = heights[i + 1] - heights[i];
    auto between = [&](auto at) {
        const auto i = std::size_t(at - steps.begin());
        return fmt::format("{:.6g} mm between {} and {}", *at, name(slices[i]), name(slices[i + 1]));
    };
    const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    if (*most > 1.5 * usual)
        refuse(fmt::format("a distance of {} where others have {:.6g} mm (slices are missing)", between(most),
                           usual),
               path, "add the missing files, or export it with even distances");
    refuse(fmt::format("uneven distances of slices, {}, but {},", between(least), between(most)), path,
           "resample it to even distances, as 3D Slicer does");
}

// The evenly spaced places that fit the slices best. If positions are visibly rounded, a distance that the
// file states is preferred if it agrees.
Line even_line(const Group& slices, const std::vector<double>& heights, double rounding,
               std::vector<std::string>& notes, const std::filesystem::path& path) {
    Line line = line_through(heights);
    if (!(line.step > 0)) refuse("slices at one place", path, "export one volume alone");
    for (const double stated : {slices[0].between, slices[0].thickness}) {
        if (stated <= 0 || line.farthest(heights) < 1e-3 * line.step) continue;
        const Line other = line_through(heights, stated);
        if (other.farthest(heights) <= 0.51 * rounding) {
            line = other;
            break;
        }
    }
    const double farthest = line.farthest(heights);
    if (farthest > std::max(bearable * line.step, std::min(rounding, 0.3 * line.step)))
        refuse_uneven(slices, heights, path);
    if (farthest > even * line.step)
        notes.push_back(fmt::format(
            "slices are taken as {:.6g} mm apart; they lie up to {:.2g} mm from there", line.step, farthest));
    return line;
}

void check_straight(const Group& slices, const Line& line, double rounding,
                    const std::filesystem::path& path) {
    const dvec3 up = (*slices[0].direction)[2], first = *slices[0].position;
    auto sideways = [&](const Slice& slice) {
        const dvec3 way = *slice.position - first;
        return way - up * glm::dot(way, up);
    };
    const double whole = line.step * double(slices.size() - 1);
    const dvec3 shift = sideways(slices.back()) / whole;
    double crooked = 0, most = 0;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const double along = line.step * double(i);
        most = std::max(most, glm::length(sideways(slices[i])) - alike * along);
        crooked = std::max(crooked, glm::distance(sideways(slices[i]), shift * along));
    }
    const double allowed = even * line.step + 2 * rounding;
    if (most <= allowed) return;
    if (crooked <= allowed)
        refuse(fmt::format(
                   "slices that shift sideways by {:.3g} mm from the first to the last (a tilted gantry, "
                   "{:.3g} degrees)",
                   glm::length(shift) * whole, std::atan(glm::length(shift)) * 180 / std::numbers::pi),
               path, "resample it to axes at right angles, as 3D Slicer or dcm2niix do");
    refuse(fmt::format("slices that do not lie above each other, {:.3g} mm sideways,", most), path,
           "export each stack into a folder of its own");
}

void note_spacing(const Slice& slice, std::vector<std::string>& notes) {
    if (slice.spacing_source.empty())
        notes.push_back("without PixelSpacing, 1 mm is assumed");
    else if (slice.spacing_source != "PixelSpacing")
        notes.push_back(fmt::format("without PixelSpacing, {} is taken, {} x {} mm", slice.spacing_source,
                                    slice.spacing.x, slice.spacing.y));
}

// Each doubt once, whichever slices have it.
void note_doubts(const Group& slices, std::vector<std::string>& notes) {
    std::set<std::string> all;
    for (const Slice& slice : slices) all.insert(slice.doubts.begin(), slice.doubts.end());
    notes.insert(notes.end(), all.begin(), all.end());
}

// The heights of slices without positions.
std::vector<double> guessed_heights(const Group& slices, std::vector<std::string>& notes) {
    std::vector<double> heights;
    const Slice& first = slices[0];
    if (std::ranges::all_of(slices, [](const Slice& s) { return s.location.has_value(); })) {
        notes.push_back("without positions, SliceLocation is taken, upwards");
        for (const Slice& slice : slices) heights.push_back(*slice.location);
        return heights;
    }
    const double step = first.between > 0 ? first.between : first.thickness > 0 ? first.thickness : 1;
    notes.push_back(fmt::format(
        "without positions, slices are taken upwards in the order of their numbers, {} mm apart{}", step,
        first.between > 0     ? " (SpacingBetweenSlices)"
        : first.thickness > 0 ? " (SliceThickness)"
                              : ", which is a guess"));
    for (std::size_t i = 0; i < slices.size(); ++i) heights.push_back(step * double(i));
    return heights;
}

Grid place(const Group& slices, const std::filesystem::path& path, std::vector<std::string>& notes) {
    const Slice& first = slices[0];
    note_doubts(slices, notes);
    note_spacing(first, notes);
    if (!first.direction)
        notes.push_back("without an orientation, rows are taken to the left, columns to the back");
    const dmat3 direction = first.direction.value_or(dmat3(1));
    std::vector<double> heights;
    double rounding = 0;
    if (first.position) {
        for (const Slice& slice : slices) heights.push_back(height(slice));
        const dvec3 up = glm::abs(direction[2]);
        rounding = std::ranges::min(slices, {}, &Slice::rounding).rounding * (up.x + up.y + up.z);
    } else {
        heights = guessed_heights(slices, notes);
    }
    const Line line = even_line(slices, heights, rounding, notes, path);
    if (first.position && first.direction) check_straight(slices, line, rounding, path);

    const ivec3 dims =
        checked_sizes({double(first.size.x), double(first.size.y), double(slices.size())}, path);
    const dvec3 origin =
        first.position.value_or(dvec3(0, 0, heights[0])) + direction[2] * (line.first - heights[0]);
    return checked_grid(
        dims, dmat3(direction[0] * first.spacing.x, direction[1] * first.spacing.y, direction[2] * line.step),
        origin, path);
}

// A padding value must not look like tissue. If it is below all other values, it does not, and is kept.
void clear_padding(const Group& slices, std::vector<float>& values) {
    if (std::ranges::none_of(slices, [](const Slice& slice) { return slice.padding.has_value(); })) return;
    const std::size_t each = values.size() / slices.size();
    auto is_padding = [&](std::size_t i) {
        const auto outside = slices[i / each].padding;
        return outside && values[i] >= float(outside->x) && values[i] <= float(outside->y);
    };
    float lowest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!is_padding(i)) lowest = std::min(lowest, values[i]);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] > lowest && is_padding(i)) values[i] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) { return holds_dicom(path); }

Stack stack(const std::vector<Slice>& all, const std::filesystem::path& named,
            const std::filesystem::path& path, std::vector<std::string>& notes) {
    const Group series = of_one_file(one_series(all, named, path, notes), named, notes);
    for (const Slice& slice : all)
        if (slice.damaged && slice.series == series[0].series) refuse_slice(slice);
    note_troubles(all, notes);
    Group slices = of_one_time(of_one_shape(series, named, notes), named, notes);
    if (slices.size() < 2) refuse("a single slice", named.empty() ? path : named, "name a slice of a volume");
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) {
        return std::pair(height(a), a.number) < std::pair(height(b), b.number);
    });
    const Grid grid = place(slices, path, notes);
    return {std::move(slices), grid};
}

Reading read_dicom(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) refuse("cannot open", path, "check the name and that it may be read");
    const bool index = lower_name(path) == "dicomdir";  // it stands for its folder
    const bool is_folder = index || std::filesystem::is_directory(path);
    if (!is_folder) open_file(path);  // throws Error if it is a pipe or a device, or cannot be read
    if (!is_folder && !holds_dicom(path)) refuse_start("DICOM", path);
    std::filesystem::path folder = std::filesystem::is_directory(path) ? path : path.parent_path();
    if (folder.empty()) folder = ".";
    const std::filesystem::path named = is_folder ? "" : folder / path.filename();

    std::vector<Slice> slices = scan(dicom_files(folder));
    if (is_folder && std::ranges::none_of(slices, [](const Slice& s) { return s.trouble.empty(); })) {
        const auto below = scan(dicom_files_below(folder));
        slices.insert(slices.end(), below.begin(), below.end());
        if (slices.empty())
            refuse("no DICOM file, here or in folders below,", path, "name the folder of a series");
    }
    Reading reading;
    reading.unit = 1e-3;
    const Stack chosen = stack(slices, named, path, reading.notes);
    reading.grid = chosen.grid;
    reading.values = read_pixels(chosen.slices, path);
    clear_padding(chosen.slices, reading.values);
    return reading;
}

}  // namespace palpate
