#include "palpate/files/formats/fields.h"
#include "palpate/files/formats/source.h"
#include "palpate/files/formats/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <map>
#include <sstream>

namespace palpate {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The header's fields for one axis of the array.
struct Axis {
    double size = 0, spacing = unknown, low = unknown, high = unknown;
    std::string kind, centre, unit;
    std::optional<dvec3> step;  // in space

    bool is_point() const { return centre == "node"; }
};

std::vector<std::string> words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> all;
    for (std::string one; in >> one;) all.push_back(lower_case(one));
    return all;
}

// "mm" "mm" "mm"
std::vector<std::string> quoted(const std::string& text) {
    std::vector<std::string> all;
    for (std::size_t from = text.find('"'); from != std::string::npos;) {
        const std::size_t to = text.find('"', from + 1);
        if (to == std::string::npos) break;
        all.push_back(lower_case(text.substr(from + 1, to - from - 1)));
        from = text.find('"', to + 1);
    }
    return all;
}

// (1,0,0) none (0,1,0), with nothing for "none".
std::vector<std::optional<dvec3>> vectors(const std::string& text, const std::filesystem::path& path) {
    std::vector<std::optional<dvec3>> all;
    for (std::size_t at = text.find_first_not_of(' '); at != std::string::npos;
         at = text.find_first_not_of(' ', at)) {
        if (text[at] != '(') {
            all.emplace_back();
            at = text.find_first_of(" (", at);
            continue;
        }
        const std::size_t end = text.find(')', at);
        std::string_view rest = std::string_view(text).substr(at + 1, end - at - 1);
        std::vector<double> numbers;
        for (auto one = word(rest, " ,"); !one.empty(); one = word(rest, " ,"))
            numbers.push_back(parse_number(one).value_or(unknown));
        if (end == std::string::npos || numbers.size() != 3)
            refuse("a place or direction that is not of three numbers", path,
                   "give a volume of three dimensions");
        all.emplace_back(dvec3(numbers[0], numbers[1], numbers[2]));
        at = end + 1;
    }
    return all;
}

std::vector<Axis> axes_of(const Fields& fields, const std::filesystem::path& path) {
    std::vector<Axis> axes;
    for (double size : fields.numbers("sizes", 0, path)) axes.emplace_back().size = size;
    const std::size_t count = axes.size();
    auto each = [&](const auto& all, auto give) {
        for (std::size_t i = 0; i < std::min(count, all.size()); ++i) give(axes[i], all[i]);
    };
    each(fields.numbers("spacings", count, path), [](Axis& axis, double v) { axis.spacing = v; });
    each(fields.numbers("axismins", count, path), [](Axis& axis, double v) { axis.low = v; });
    each(fields.numbers("axismaxs", count, path), [](Axis& axis, double v) { axis.high = v; });
    each(words(fields["kinds"]), [](Axis& axis, const std::string& v) { axis.kind = v; });
    each(words(fields["centers"] + fields["centerings"]),
         [](Axis& axis, const std::string& v) { axis.centre = v; });
    each(quoted(fields["units"]), [](Axis& axis, const std::string& v) { axis.unit = v; });
    each(vectors(fields["spacedirections"], path), [](Axis& axis, auto v) { axis.step = v; });
    return axes;
}

// Which axes of the array are spatial.
std::vector<std::size_t> in_space(const Fields& fields, const std::vector<Axis>& axes) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const bool domain = axes[i].kind.empty() || axes[i].kind == "domain" || axes[i].kind == "space";
        if (fields.has("spacedirections") ? axes[i].step.has_value() : domain) all.push_back(i);
    }
    for (std::size_t i = all.size(); i-- > 0 && all.size() > 3;)
        if (axes[all[i]].size == 1) all.erase(all.begin() + std::ptrdiff_t(i));
    return all;
}

// Sets the layout to keep the first entry along the one axis that is not spatial, if there is one.
void leave_out(const std::vector<Axis>& axes, const std::vector<std::size_t>& space, Layout& layout,
               std::vector<std::string>& notes, const std::filesystem::path& path) {
    double run = 1;
    for (std::size_t i = 0; i < axes.size(); run *= axes[i++].size) {
        const Axis& axis = axes[i];
        if (std::find(space.begin(), space.end(), i) != space.end() || axis.size == 1) continue;
        const bool one_of_many = axis.kind.empty() || axis.kind == "list" || axis.kind == "time" ||
                                 axis.kind == "none" || axis.kind == "???" || axis.kind == "domain";
        if (!one_of_many || layout.every > 1)
            refuse(fmt::format("{} numbers a voxel (colours or vectors)", axis.size), path,
                   "convert it to one number a voxel");
        if (!is_whole(axis.size, 1, 1 << 24)) refuse(fmt::format("an axis of size {}", axis.size), path);
        layout.run = std::size_t(run);
        layout.every = std::size_t(axis.size);
        notes.push_back(fmt::format("{} volumes in one file: the first is taken", axis.size));
    }
}

// From the axes of a named space to ours; those of a space without names stay.
dvec3 turn_of(const std::string& space, std::vector<std::string>& notes) {
    auto is = [&](const char* name, const char* letters) {
        return space.starts_with(name) || space == letters || space == std::string(letters) + "t";
    };
    if (is("right-anterior-superior", "ras")) return {-1, -1, 1};
    if (is("left-anterior-superior", "las")) return {1, -1, 1};
    if (is("left-posterior-superior", "lps")) return dvec3(1);
    notes.push_back("it does not state its orientation: x is taken as left, y as back, z as up");
    return dvec3(1);
}

double spacing_of(const Axis& axis, bool& guessed) {
    if (std::isfinite(axis.spacing)) return axis.spacing;
    const double steps = axis.is_point() ? axis.size - 1 : axis.size;
    if (std::isfinite(axis.high - axis.low) && steps > 0) return (axis.high - axis.low) / steps;
    guessed = true;
    return 1;
}

Grid place_of(const Fields& fields, const std::vector<Axis>& axes, const std::vector<std::size_t>& space,
              std::vector<std::string>& notes, const std::filesystem::path& path) {
    std::vector<double> sizes;
    for (std::size_t i : space) sizes.push_back(axes[i].size);
    const ivec3 dims = checked_sizes(sizes, path);
    dmat3 steps(0);
    dvec3 origin(0);
    bool guessed = false;
    for (int k = 0; k < 3; ++k) {
        const Axis& axis = axes[space[std::size_t(k)]];
        if (axis.step) {
            steps[k] = *axis.step;
            continue;
        }
        steps[k][k] = spacing_of(axis, guessed);
        if (std::isfinite(axis.low)) origin[k] = axis.low + (axis.is_point() ? 0 : 0.5 * steps[k][k]);
    }
    if (guessed) notes.push_back(no_spacing);
    if (const auto at = vectors(fields["spaceorigin"], path); at.size() == 1 && at[0]) origin = *at[0];
    const dvec3 turn = turn_of(lower_case(fields["space"]), notes);
    return checked_grid(dims, dmat3(turn * steps[0], turn * steps[1], turn * steps[2]), turn * origin, path);
}

// In metres; 0 where none is stated.
double unit_of(const Fields& fields, const std::vector<Axis>& axes, const std::vector<std::size_t>& space,
               std::vector<std::string>& notes, const std::filesystem::path& path) {
    std::vector<std::string> names = quoted(fields["spaceunits"]);
    if (names.empty())
        for (std::size_t i : space) names.push_back(axes[i].unit);
    names.resize(std::min<std::size_t>(names.size(), 3));
    if (std::adjacent_find(names.begin(), names.end(), std::not_equal_to<>()) != names.end())
        refuse("axes in different units of length", path, "write it with one unit");
    return named_unit(names.empty() ? "" : names[0], notes);
}

Number nrrd_number(const std::string& type, const std::filesystem::path& path) {
    static const std::map<std::string, Number> all = {
        {"signed char", Number::int8},    {"int8", Number::int8},
        {"int8_t", Number::int8},         {"uchar", Number::uint8},
        {"unsigned char", Number::uint8}, {"uint8", Number::uint8},
        {"uint8_t", Number::uint8},       {"short", Number::int16},
        {"int16", Number::int16},         {"int16_t", Number::int16},
        {"ushort", Number::uint16},       {"unsigned short", Number::uint16},
        {"uint16", Number::uint16},       {"uint16_t", Number::uint16},
        {"int", Number::int32},           {"signed int", Number::int32},
        {"int32", Number::int32},         {"int32_t", Number::int32},
        {"uint", Number::uint32},         {"unsigned int", Number::uint32},
        {"uint32", Number::uint32},       {"uint32_t", Number::uint32},
        {"longlong", Number::int64},      {"long long", Number::int64},
        {"int64", Number::int64},         {"int64_t", Number::int64},
        {"ulonglong", Number::uint64},    {"unsigned long long", Number::uint64},
        {"uint64", Number::uint64},       {"uint64_t", Number::uint64},
        {"float", Number::float32},       {"double", Number::float64}};
    // "signed short int" is "short".
    std::string name;
    const std::vector<std::string> parts = words(type);
    for (const std::string& part : parts) {
        const bool padding = (part == "int" && parts.size() > 1 && !name.empty() && name != "unsigned") ||
                             (part == "signed" && parts.size() > 1 && parts[1] != "char");
        if (!padding) name += (name.empty() ? "" : " ") + part;
    }
    const auto found = all.find(name);
    if (found == all.end())
        refuse("voxels of the type " + in_quotes(type) + ", which is not read,", path,
               "convert it to numbers");
    return found->second;
}

Packing packing_of(const std::string& encoding, const std::filesystem::path& path) {
    if (encoding == "raw") return Packing::none;
    if (encoding == "ascii" || encoding == "text" || encoding == "txt") return Packing::text;
    if (encoding == "hex") return Packing::hex;
    if (encoding == "gzip" || encoding == "gz") return Packing::gzip;
    if (encoding == "bzip2" || encoding == "bz2") return Packing::bzip2;
    refuse("the encoding " + in_quotes(encoding) + ", which is not read,", path, "write it as raw or gzip");
}

std::int64_t skipped(const Fields& fields, const char* name, std::int64_t least,
                     const std::filesystem::path& path) {
    const auto numbers = fields.numbers(name, 1, path);
    if (numbers.empty()) return 0;
    if (!is_whole(numbers[0], double(least), 1e15))
        refuse(fmt::format("\"{}\" of {}", name, numbers[0]), path);
    return std::int64_t(numbers[0]);
}

Layout layout_of(const Fields& fields, std::vector<std::string>& notes, const std::filesystem::path& path) {
    Layout layout;
    layout.number = nrrd_number(fields["type"], path);
    layout.packing = packing_of(lower_case(fields["encoding"]), path);
    layout.big_endian = lower_case(fields["endian"]) == "big";
    if (!fields.has("endian") && bytes_of(layout.number) > 1 && layout.packing != Packing::text)
        notes.push_back("it does not state its byte order: little-endian is assumed");
    layout.skipped_lines = skipped(fields, "lineskip", 0, path);
    layout.skipped_bytes = skipped(fields, "byteskip", -1, path);
    return layout;
}

}  // namespace

Reading read_nrrd(const std::filesystem::path& path) {
    const auto in = open_file(path);
    const Fields fields = read_fields(*in, ':', "", path);
    if (!fields.first.starts_with("NRRD")) refuse_start("NRRD", path);

    Reading reading;
    const std::vector<Axis> axes = axes_of(fields, path);
    const std::vector<std::size_t> space = in_space(fields, axes);
    Layout layout = layout_of(fields, reading.notes, path);
    reading.grid = place_of(fields, axes, space, reading.notes, path);
    reading.unit = unit_of(fields, axes, space, reading.notes, path);
    leave_out(axes, space, layout, reading.notes, path);
    layout.voxels = reading.grid.count();

    const std::string data = fields["datafile"];
    reading.values = data.empty() ? read_voxels(*in, layout, path)
                                  : read_voxels(data_files(fields, data, path), layout, path);
    return reading;
}

}  // namespace palpate
