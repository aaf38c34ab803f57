#include "palpate/files/formats/fields.h"
#include "palpate/files/formats/source.h"
#include "palpate/files/formats/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <istream>
#include <utility>

namespace palpate {
namespace {

Number metaimage_number(std::string type, const std::filesystem::path& path) {
    constexpr std::pair<const char*, Number> all[] = {
        {"met_char", Number::int8},         {"met_uchar", Number::uint8},   {"met_short", Number::int16},
        {"met_ushort", Number::uint16},     {"met_int", Number::int32},     {"met_uint", Number::uint32},
        {"met_long", Number::int32},        {"met_ulong", Number::uint32},  {"met_long_long", Number::int64},
        {"met_ulong_long", Number::uint64}, {"met_float", Number::float32}, {"met_double", Number::float64}};
    type = lower_case(type);
    if (type.ends_with("_array")) type.resize(type.size() - 6);
    for (auto [name, number] : all)
        if (type == name) return number;
    refuse("voxels of the type " + in_quotes(type) + ", which is not read,", path, "convert it to numbers");
}

// The numbers of the first of these fields that the file has.
std::vector<double> first_of(const Fields& fields, std::initializer_list<const char*> names,
                             std::size_t least, const std::filesystem::path& path) {
    for (const char* name : names)
        if (fields.has(name)) return fields.numbers(name, least, path);
    return {};
}

std::size_t dimensions(const Fields& fields, const std::vector<double>& sizes,
                       const std::filesystem::path& path) {
    const auto stated = fields.numbers("ndims", 1, path);
    if (!stated.empty() && stated[0] != double(sizes.size()))
        refuse(fmt::format("{} sizes for {} dimensions", sizes.size(), stated[0]), path);
    return sizes.size();
}

Grid place_of(const Fields& fields, ivec3 dims, std::size_t count, std::vector<std::string>& notes,
              const std::filesystem::path& path) {
    std::vector<double> spacing = fields.numbers("elementspacing", count, path);
    if (spacing.empty()) {
        spacing = fields.numbers("elementsize", count, path);
        notes.push_back(spacing.empty() ? no_spacing
                                        : "it states no spacing: the size of a voxel is taken for it");
        if (spacing.empty()) spacing.assign(count, 1);
    }
    const auto turn = first_of(fields, {"transformmatrix", "rotation", "orientation"}, count * count, path);
    const auto offset = first_of(fields, {"offset", "position", "origin"}, count, path);
    // ITK does not apply it either, so that a volume lies where ITK's programs show it.
    if (const auto centre = fields.numbers("centerofrotation", 0, path);
        std::ranges::any_of(centre, [](double c) { return c != 0; }))
        notes.push_back(
            "its CenterOfRotation is left out: its Offset is taken as the place of the first voxel");
    dmat3 steps(0);
    dvec3 origin(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row)
            steps[int(axis)][int(row)] =
                spacing[axis] * (turn.empty() ? double(axis == row) : turn[axis * count + row]);
        if (!offset.empty()) origin[int(axis)] = offset[axis];
    }
    return checked_grid(dims, steps, origin, path);
}

bool is_true(const Fields& fields, const char* name) { return fields[name].find_first_of("Tt1") == 0; }

Layout layout_of(const Fields& fields, const std::filesystem::path& path) {
    Layout layout;
    layout.number = metaimage_number(fields["elementtype"], path);
    layout.packing = is_true(fields, "compresseddata")                            ? Packing::gzip
                     : fields.has("binarydata") && !is_true(fields, "binarydata") ? Packing::text
                                                                                  : Packing::none;
    layout.big_endian = is_true(fields, "binarydatabyteordermsb") || is_true(fields, "elementbyteordermsb");
    if (const auto slope = fields.numbers("elementtointensityfunctionslope", 1, path);
        !slope.empty() && slope[0] != 0)
        layout.slope = slope[0];
    if (const auto offset = fields.numbers("elementtointensityfunctionoffset", 1, path); !offset.empty())
        layout.intercept = offset[0];
    return layout;
}

}  // namespace

Reading read_metaimage(const std::filesystem::path& path) {
    const auto in = open_file(path);
    const Fields fields = read_fields(*in, '=', "elementdatafile", path);
    if (const std::string kind = fields["objecttype"]; !kind.empty() && lower_case(kind) != "image")
        refuse("not an image (its ObjectType is " + in_quotes(kind) + ")", path,
               "give a file whose ObjectType is Image");
    const std::string data = fields["elementdatafile"];
    if (data.empty() || !fields.has("dimsize")) refuse_start("MetaImage", path);

    Reading reading;
    std::vector<double> sizes = fields.numbers("dimsize", 1, path);
    const std::size_t count = dimensions(fields, sizes, path);
    double volumes = 1;
    for (; sizes.size() > 3; sizes.pop_back()) volumes *= sizes.back();
    const ivec3 dims = checked_sizes(sizes, path);
    if (const auto channels = fields.numbers("elementnumberofchannels", 1, path);
        !channels.empty() && channels[0] != 1)
        refuse(fmt::format("{} numbers a voxel (colours or vectors)", channels[0]), path,
               "convert it to one number a voxel");
    if (!is_whole(volumes, 1, 1 << 24)) refuse(fmt::format("{} volumes in one file", volumes), path);
    if (volumes > 1)
        reading.notes.push_back(fmt::format("{} volumes in one file: the first is taken", volumes));
    reading.grid = place_of(fields, dims, count, reading.notes, path);
    reading.unit = named_unit(lower_case(fields["distanceunits"]), reading.notes);

    Layout layout = layout_of(fields, path);
    layout.voxels = layout.run = reading.grid.count();
    layout.every = std::size_t(volumes);
    if (lower_case(data) == "local") {
        reading.values = read_voxels(*in, layout, path);
    } else {
        const auto header = fields.numbers("headersize", 1, path);
        if (!header.empty() && is_whole(header[0], -1, 1e15)) layout.skipped_bytes = std::int64_t(header[0]);
        reading.values = read_voxels(data_files(fields, data, path), layout, path);
    }
    return reading;
}

}  // namespace palpate
