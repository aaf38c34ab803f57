#include "palpate/base/error.h"
#include "palpate/base/isolated.h"
#include "palpate/files/formats/dicom.h"
#include "palpate/files/formats/source.h"

#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmImageHelper.h>
#include <gdcmImageReader.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmUIDs.h>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

// GDCM crashes on some files, or allocates without limit. So it runs in processes of its own.

namespace palpate {
namespace {

using gdcm::DataSet;
using gdcm::Tag;
using Json = nlohmann::json;

const Tag pixels(0x7fe0, 0x0010);

// The sequences in which a multi-frame file stores what others store at top level.
const Tag pixel_measures(0x0028, 0x9110), value_transformation(0x0028, 0x9145),
    plane_position(0x0020, 0x9113), plane_orientation(0x0020, 0x9116);

// ---- the attributes of a header ----

std::string unpadded(std::string text) {
    text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
    const std::size_t first = text.find_first_not_of(' ');
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

std::string text(const DataSet& set, const Tag& tag) {
    if (!set.FindDataElement(tag)) return "";
    const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
    return value ? unpadded(std::string(value->GetPointer(), value->GetLength())) : "";
}

const DataSet* item(const DataSet& set, const Tag& tag, std::size_t number) {
    if (!set.FindDataElement(tag)) return nullptr;
    const auto sequence = set.GetDataElement(tag).GetValueAsSQ();
    if (!sequence || number >= sequence->GetNumberOfItems()) return nullptr;
    return &sequence->GetItem(number + 1).GetNestedDataSet();
}

// The attributes of one frame: its own and the shared ones of a multi-frame file, then the file's.
struct Attributes {
    const DataSet& file;
    const DataSet* own = nullptr;
    const DataSet* shared = nullptr;

    // `group`: the sequence in which a multi-frame file stores it.
    std::string operator()(const Tag& tag, const Tag& group) const {
        for (const DataSet* set : {own, shared})
            if (const DataSet* inner = set ? item(*set, group, 0) : nullptr)
                if (const std::string found = text(*inner, tag); !found.empty()) return found;
        return text(file, tag);
    }
    std::string operator()(const Tag& tag) const { return text(file, tag); }
    // A binary number of a frame.
    template <std::uint16_t Group, std::uint16_t Element>
    std::string binary(const Tag& group) const {
        const DataSet* inner = own ? item(*own, group, 0) : nullptr;
        const DataSet& set = inner ? *inner : file;
        gdcm::Attribute<Group, Element> attribute;
        if (!set.FindDataElement(attribute.GetTag())) return "";
        attribute.SetFromDataSet(set);
        return fmt::format("{}", attribute.GetValue());
    }
};

// "1.25\-3": nothing unless all are finite numbers. Some exporters write "1,25", which is unambiguous.
std::vector<double> numbers(std::string text) {
    std::ranges::replace(text, ',', '.');
    std::string_view rest = text;
    std::vector<double> all;
    while (!rest.empty()) {
        std::string_view one = until('\\', rest);
        const auto number = parse_number(word(one, " "));
        if (!number || !std::isfinite(*number)) return {};
        all.push_back(*number);
    }
    return all;
}

std::optional<double> number(const std::string& text) {
    const auto all = numbers(text);
    return all.empty() ? std::nullopt : std::optional(all[0]);
}

// The last decimal place of the most precise of some numbers, ignoring final zeros: 0.1 for "12.5\3".
double last_place(std::string_view text) {
    int most = 0;
    if (text.find_first_of("eE") != std::string_view::npos) return 1e-6;
    while (!text.empty()) {
        std::string_view one = until('\\', text);
        one = word(one, " ");
        const std::size_t point = one.find_first_of(".,"), last = one.find_last_not_of('0');
        if (point != std::string_view::npos && last > point) most = std::max(most, int(last - point));
    }
    return std::pow(10.0, -most);
}

// Rows, columns and their cross product, all unit and at right angles.
std::optional<dmat3> direction_of(const std::string& text) {
    const auto n = numbers(text);
    if (n.size() != 6) return std::nullopt;
    const dvec3 row(n[0], n[1], n[2]), column(n[3], n[4], n[5]);
    const double area = glm::length(glm::cross(row, column));
    if (!(area > 0.99 && area < 1.01 && std::abs(glm::dot(row, column)) < 0.01)) return std::nullopt;
    const dvec3 x = glm::normalize(row), z = glm::normalize(glm::cross(row, column));
    return dmat3(x, glm::cross(z, x), z);
}

void find_spacing(const Attributes& attribute, Slice& slice) {
    const std::pair<const char*, Tag> sources[] = {{"PixelSpacing", Tag(0x0028, 0x0030)},
                                                   {"ImagerPixelSpacing", Tag(0x0018, 0x1164)},
                                                   {"NominalScannedPixelSpacing", Tag(0x0018, 0x2010)}};
    for (const auto& [name, tag] : sources) {
        const auto n = numbers(attribute(tag, pixel_measures));
        if (n.size() < 2 || !(n[0] > 0 && n[1] > 0)) continue;
        slice.spacing = dvec2(n[1], n[0]);  // the first is from row to row
        slice.spacing_source = name;
        return;
    }
}

std::vector<std::pair<std::string, std::string>> marks_of(const Attributes& attribute,
                                                          const std::filesystem::path& file) {
    const Tag content(0x0020, 0x9111), none(0, 0);
    return {{"AcquisitionNumber", attribute(Tag(0x0020, 0x0012))},
            {"TemporalPositionIdentifier", attribute(Tag(0x0020, 0x0100))},
            {"TemporalPositionIndex", attribute.binary<0x0020, 0x9128>(content)},
            {"StackID", attribute(Tag(0x0020, 0x9056), content)},
            {"EchoNumbers", attribute(Tag(0x0018, 0x0086))},
            {"EchoTime", attribute(Tag(0x0018, 0x0081))},
            {"EffectiveEchoTime", attribute.binary<0x0018, 0x9082>(Tag(0x0018, 0x9114))},
            {"InversionTime", attribute(Tag(0x0018, 0x0082))},
            {"TriggerTime", attribute(Tag(0x0018, 0x1060))},
            {"NominalPercentageOfCardiacPhase", attribute(Tag(0x0020, 0x9241))},
            {"DiffusionBValue", attribute.binary<0x0018, 0x9087>(Tag(0x0018, 0x9117))},
            {"ImageType", attribute(Tag(0x0008, 0x0008))},
            {"FrameType", attribute(Tag(0x0008, 0x9007), Tag(0x0018, 0x9226))},
            {"AcquisitionTime", attribute(Tag(0x0008, 0x0032))},
            {"AcquisitionDateTime", attribute(Tag(0x0008, 0x002a))},
            {"ContentTime", attribute(Tag(0x0008, 0x0033))},
            {"their files", attribute.own ? file.filename().string() : ""}};
}

// The numbers of 16 bits that an attribute holds.
std::vector<std::uint16_t> words(const DataSet& set, const Tag& tag) {
    const gdcm::ByteValue* value =
        set.FindDataElement(tag) ? set.GetDataElement(tag).GetByteValue() : nullptr;
    if (!value) return {};
    std::vector<std::uint16_t> all(value->GetLength() / sizeof(std::uint16_t));
    std::memcpy(all.data(), value->GetPointer(), all.size() * sizeof(std::uint16_t));
    return all;
}

bool is_signed(const gdcm::PixelFormat& format) { return format.GetPixelRepresentation() == 1; }

double as_stored(std::uint16_t word, bool has_sign) {
    return has_sign ? double(std::int16_t(word)) : double(word);
}

// The Modality LUT, which maps stored numbers to values in place of slope and intercept.
struct LookUpTable {
    double first = 0;  // the stored number that its first value is for
    std::vector<float> values;

    // Numbers beyond either end get the value at that end.
    float operator()(double stored) const {
        return values[std::size_t(std::clamp(stored - first, 0.0, double(values.size() - 1)))];
    }
};

const Tag tables(0x0028, 0x3000);

// Without values if there is none, or if it is incomplete.
LookUpTable table_of(const DataSet& set, bool has_sign) {
    const DataSet* lut = item(set, tables, 0);
    if (!lut) return {};
    const auto head = words(*lut, Tag(0x0028, 0x3002)), data = words(*lut, Tag(0x0028, 0x3006));
    if (head.size() != 3) return {};
    const std::size_t count = head[0] == 0 ? 1 << 16 : head[0];
    LookUpTable table{as_stored(head[1], has_sign), {}};
    if (data.size() >= count) {
        table.values.assign(data.begin(), data.begin() + std::ptrdiff_t(count));
    } else if (head[2] == 8 && data.size() == (count + 1) / 2) {  // two to a word, the first one low
        for (std::size_t i = 0; i < count; ++i)
            table.values.push_back(float(i % 2 == 0 ? data[i / 2] & 0xff : data[i / 2] >> 8));
    }
    return table;
}

// The range of pixel padding, as stored (PS3.3 C.7.5.1.1.2).
std::optional<dvec2> padding_of(const DataSet& set, bool has_sign) {
    const auto one = words(set, Tag(0x0028, 0x0120)), limit = words(set, Tag(0x0028, 0x0121));
    if (one.empty()) return std::nullopt;
    const double a = as_stored(one[0], has_sign), b = limit.empty() ? a : as_stored(limit[0], has_sign);
    return dvec2(std::min(a, b), std::max(a, b));
}

double value_of(double stored, const Slice& slice, const LookUpTable& table) {
    return table.values.empty() ? stored * slice.slope + slice.intercept : double(table(stored));
}

// Notes on a slice's numbers that are malformed.
std::vector<std::string> doubts_of(const Attributes& attribute) {
    const struct {
        const char* name;
        Tag tag, group;
        std::size_t count;
    } all[] = {{"ImagePositionPatient", Tag(0x0020, 0x0032), plane_position, 3},
               {"ImageOrientationPatient", Tag(0x0020, 0x0037), plane_orientation, 6},
               {"PixelSpacing", Tag(0x0028, 0x0030), pixel_measures, 2},
               {"SliceThickness", Tag(0x0018, 0x0050), pixel_measures, 1},
               {"SpacingBetweenSlices", Tag(0x0018, 0x0088), pixel_measures, 1},
               {"SliceLocation", Tag(0x0020, 0x1041), pixel_measures, 1},
               {"RescaleSlope", Tag(0x0028, 0x1053), value_transformation, 1},
               {"RescaleIntercept", Tag(0x0028, 0x1052), value_transformation, 1}};
    std::vector<std::string> doubts;
    for (const auto& [name, tag, group, count] : all) {
        const std::string value = attribute(tag, group);
        if (value.empty()) continue;
        if (numbers(value).size() < count)
            doubts.push_back(fmt::format("its {} cannot be read and is left out", name));
        else if (value.find(',') != std::string::npos)
            doubts.push_back(fmt::format("its {} has decimal commas: they are read as points", name));
    }
    return doubts;
}

Slice slice_of(const Attributes& attribute, const Slice& plain, bool has_sign) {
    Slice slice = plain;
    slice.marks = marks_of(attribute, plain.file);
    find_spacing(attribute, slice);
    slice.direction = direction_of(attribute(Tag(0x0020, 0x0037), plane_orientation));
    const std::string position = attribute(Tag(0x0020, 0x0032), plane_position);
    if (const auto n = numbers(position); n.size() == 3) {
        slice.position = dvec3(n[0], n[1], n[2]);
        slice.rounding = last_place(position);
    }
    slice.location = number(attribute(Tag(0x0020, 0x1041)));
    slice.thickness = number(attribute(Tag(0x0018, 0x0050), pixel_measures)).value_or(0);
    slice.between = std::abs(number(attribute(Tag(0x0018, 0x0088), pixel_measures)).value_or(0));
    if (const auto slope = number(attribute(Tag(0x0028, 0x1053), value_transformation)); slope && *slope != 0)
        slice.slope = *slope;
    if (const auto dose = number(attribute(Tag(0x3004, 0x000e)))) slice.slope = *dose;
    slice.intercept = number(attribute(Tag(0x0028, 0x1052), value_transformation)).value_or(0);
    slice.doubts = doubts_of(attribute);
    if (const auto padding = padding_of(attribute.file, has_sign)) {
        const LookUpTable table = table_of(attribute.file, has_sign);
        const double a = value_of(padding->x, slice, table), b = value_of(padding->y, slice, table);
        slice.padding = dvec2(std::min(a, b), std::max(a, b));
    }
    return slice;
}

// ---- which files have slices ----

Slice troubled(Slice slice, const std::string& trouble, const std::string& remedy) {
    slice.trouble = trouble;
    slice.remedy = remedy;
    return slice;
}

Slice of_file(const std::filesystem::path& file) {
    Slice slice;
    slice.file = file;
    return slice;
}

Slice damaged(Slice slice) {
    slice.damaged = true;
    return troubled(std::move(slice), "a truncated or damaged DICOM file", "get it again, or move it away");
}

// A compression that GDCM cannot decode, or an unknown transfer syntax.
Slice packed(Slice slice, const gdcm::File& file) {
    const std::string syntax = text(file.GetHeader(), Tag(0x0002, 0x0010));
    return troubled(std::move(slice),
                    fmt::format("pixels that GDCM cannot decompress (transfer syntax {})", syntax),
                    "export it uncompressed, as Explicit VR Little Endian");
}

// "RT Structure Set Storage"
std::string kind_of(const std::string& uid) {
    gdcm::UIDs known;
    const char* name = known.SetFromUID(uid.c_str()) ? known.GetName() : nullptr;
    return name ? name : uid;
}

// Why a file with a complete header has no slices; nothing if it may have some.
std::optional<Slice> unusable(const gdcm::File& file, const Slice& plain) {
    const DataSet& set = file.GetDataSet();
    std::string kind = text(set, Tag(0x0008, 0x0016));
    if (kind.empty()) kind = text(file.GetHeader(), Tag(0x0002, 0x0002));
    const std::string name = kind.empty() ? "a data set" : kind_of(kind);
    const gdcm::MediaStorage::MSType type = gdcm::MediaStorage::GetMSType(kind.c_str());
    if (name.find("Segmentation") != std::string::npos || name.find("RT Structure Set") != std::string::npos)
        return troubled(plain, "labels or contours, not a scan (" + name + ")",
                        "turn it into a label volume, as 3D Slicer does");
    if (type != gdcm::MediaStorage::MS_END && !gdcm::MediaStorage::IsImage(type))
        return troubled(plain, "not an image (" + name + ")", "name a file of slices");
    const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
    const gdcm::PhotometricInterpretation light = gdcm::ImageHelper::GetPhotometricInterpretationValue(file);
    if (format.GetSamplesPerPixel() != 1 || light == gdcm::PhotometricInterpretation::PALETTE_COLOR)
        return troubled(plain, fmt::format("colours ({})", unpadded(light.GetString())),
                        "convert it to one number a voxel");
    if (text(set, Tag(0x0008, 0x0008)).find("MOSAIC") != std::string::npos)
        return troubled(plain, "slices tiled into one picture (a Siemens mosaic)",
                        "convert it with dcm2niix");
    if (set.FindDataElement(Tag(0x7fe0, 0x0008)) || set.FindDataElement(Tag(0x7fe0, 0x0009)))
        return troubled(plain, "float pixels (FloatPixelData), which are not read,",
                        "export it with whole numbers, or as NIfTI or NRRD");
    if (set.FindDataElement(tables) && table_of(set, is_signed(format)).values.empty())
        return troubled(plain, "an incomplete lookup table (ModalityLUTSequence)",
                        "export it with RescaleSlope and RescaleIntercept");
    return std::nullopt;
}

// The slices of a multi-frame file, of which the i-th lies `offsets[i]` above `first`.
std::vector<Slice> stacked(Slice plain, dvec3 first, std::span<const double> offsets) {
    std::vector<Slice> all;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        plain.frame = plain.number = int(i);
        plain.position = first + (*plain.direction)[2] * offsets[i];
        plain.marks.back().second = plain.file.filename().string();
        all.push_back(plain);
    }
    return all;
}

// The slices of a radiation dose, which states their offsets from the first. Empty for other files.
std::vector<Slice> dose_slices(const DataSet& set, const Slice& plain, std::size_t frames) {
    const auto offsets = numbers(text(set, Tag(0x3004, 0x000c)));
    if (offsets.size() != frames || offsets[0] != 0 || !plain.position || !plain.direction) return {};
    return stacked(plain, *plain.position, offsets);
}

// The slices of a nuclear medicine tomogram, which states the position of the first and the signed distance
// of the next. Empty for other files.
std::vector<Slice> tomogram_slices(const DataSet& set, Slice plain, std::size_t frames) {
    const auto order = words(set, Tag(0x0054, 0x0080));
    const Attributes detector{.file = set, .shared = &set};
    const Tag detectors(0x0054, 0x0022);
    const auto first = numbers(detector(Tag(0x0020, 0x0032), detectors));
    const double between = number(text(set, Tag(0x0018, 0x0088))).value_or(plain.thickness);
    plain.direction = direction_of(detector(Tag(0x0020, 0x0037), detectors));
    if (order.size() != frames || first.size() != 3 || between == 0 || !plain.direction) return {};
    std::vector<double> offsets;
    for (std::uint16_t place : order) offsets.push_back(between * (place - 1.0));
    return stacked(plain, {first[0], first[1], first[2]}, offsets);
}

// Why a multi-frame file is not a volume.
Slice film(const DataSet& set, const Slice& plain, std::size_t frames) {
    const bool nuclear = text(set, Tag(0x0008, 0x0060)) == "NM";
    return troubled(plain,
                    fmt::format("{} {} in one file that does not state their positions{}", frames,
                                nuclear ? "nuclear medicine frames" : "pictures", nuclear ? "" : " (a film)"),
                    nuclear ? "convert it with dcm2niix" : "give a series of slices");
}

// The slices of a file whose header GDCM has read.
std::vector<Slice> slices_of(const gdcm::File& file, Slice plain, double left) {
    const DataSet& set = file.GetDataSet();
    if (const auto slice = unusable(file, plain)) return {*slice};
    const std::vector<unsigned> sizes = gdcm::ImageHelper::GetDimensionsValue(file);
    const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
    if (sizes.size() < 2 || sizes[0] == 0 || sizes[1] == 0 || sizes[0] > 65535 || sizes[1] > 65535)
        return {damaged(plain)};
    plain.size = ivec2(sizes[0], sizes[1]);
    const std::size_t frames = sizes.size() > 2 ? std::max(sizes[2], 1u) : 1;
    const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
    const double promised = double(sizes[0]) * sizes[1] * double(frames) * format.GetPixelSize();
    // GDCM pads a truncated file. The length of a compressed one cannot be checked.
    if (!syntax.IsEncapsulated() && syntax != gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian &&
        !(promised <= left))
        return {damaged(plain)};

    const bool has_sign = is_signed(format);
    const Slice alone = slice_of({.file = set}, plain, has_sign);
    if (frames == 1 && !set.FindDataElement(Tag(0x5200, 0x9230))) return {alone};
    if (auto all = dose_slices(set, alone, frames); !all.empty()) return all;
    if (auto all = tomogram_slices(set, alone, frames); !all.empty()) return all;
    const DataSet* shared = item(set, Tag(0x5200, 0x9229), 0);
    std::vector<Slice> all;
    for (std::size_t i = 0; i < frames; ++i) {
        const DataSet* own = item(set, Tag(0x5200, 0x9230), i);
        if (!own) return {film(set, plain, frames)};
        plain.frame = int(i);
        all.push_back(slice_of({.file = set, .own = own, .shared = shared}, plain, has_sign));
        all.back().number = int(i);
    }
    return all;
}

std::vector<Slice> scan_file(const std::filesystem::path& file) try {
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    const bool readable = reader.ReadUpToTag(pixels, {pixels});
    const DataSet& set = reader.GetFile().GetDataSet();
    Slice plain = of_file(file);
    const std::string uid = text(set, Tag(0x0020, 0x000e)), patient = text(set, Tag(0x0010, 0x0020));
    // A name may be spelled in two ways, so it counts only if nothing else distinguishes patients.
    plain.series = uid + "/" + patient + "/" + (uid.empty() ? text(set, Tag(0x0010, 0x0010)) : "");
    plain.study = text(set, Tag(0x0020, 0x000d)) + "/" + patient;
    plain.description = text(set, Tag(0x0008, 0x103e));
    plain.number = int(number(text(set, Tag(0x0020, 0x0013))).value_or(0));
    plain.pixels_at = reader.GetStreamCurrentPosition();
    const auto size = std::filesystem::file_size(file);
    if (readable && plain.pixels_at >= size) {
        if (const auto slice = unusable(reader.GetFile(), plain)) return {*slice};
        plain.damaged = true;
        return {
            troubled(plain, "no pixels (it is not an image, or it is truncated)", "name a file of slices")};
    }
    const std::string syntax = text(reader.GetFile().GetHeader(), Tag(0x0002, 0x0010));
    if (!syntax.empty() && gdcm::TransferSyntax::GetTSType(syntax.c_str()) == gdcm::TransferSyntax::TS_END)
        return {packed(plain, reader.GetFile())};
    if (!readable) return {damaged(plain)};
    return slices_of(reader.GetFile(), plain, double(size) - double(plain.pixels_at));
} catch (const std::bad_alloc&) {
    throw;
} catch (const std::exception&) {  // GDCM's
    return {damaged(of_file(file))};
}

// ---- between two processes ----

// Visits each field of a slice with its name, but for its file, of which only the index is sent.
template <class AnySlice, class Visit>
void for_each_field(AnySlice& slice, const Visit& visit) {
    visit("frame", slice.frame);
    visit("trouble", slice.trouble);
    visit("remedy", slice.remedy);
    visit("damaged", slice.damaged);
    visit("series", slice.series);
    visit("study", slice.study);
    visit("description", slice.description);
    visit("number", slice.number);
    visit("marks", slice.marks);
    visit("size", slice.size);
    visit("spacing", slice.spacing);
    visit("spacing_source", slice.spacing_source);
    visit("direction", slice.direction);
    visit("position", slice.position);
    visit("rounding", slice.rounding);
    visit("location", slice.location);
    visit("thickness", slice.thickness);
    visit("between", slice.between);
    visit("slope", slice.slope);
    visit("intercept", slice.intercept);
    visit("padding", slice.padding);
    visit("doubts", slice.doubts);
    visit("pixels_at", slice.pixels_at);
}

// The numbers of a vector or a matrix.
template <class T>
auto span_of(T& value) {
    auto* const first = glm::value_ptr(value);
    return std::span(first, sizeof value / sizeof *first);
}

// An empty optional is null; a vector or a matrix is a list of its numbers.
template <class T>
Json json_of(const T& value) {
    if constexpr (requires { value.has_value(); }) {
        return value ? json_of(*value) : Json();
    } else if constexpr (requires { T::length(); }) {
        const auto numbers = span_of(value);
        return std::vector(numbers.begin(), numbers.end());
    } else {
        return value;
    }
}

template <class T>
void assign(T& value, const Json& json) {
    if constexpr (requires { value.has_value(); }) {
        if (!json.is_null()) assign(value.emplace(), json);
    } else if constexpr (requires { T::length(); }) {
        for (std::size_t i = 0; auto& number : span_of(value)) json.at(i++).get_to(number);
    } else {
        json.get_to(value);
    }
}

Json json_of(const Slice& slice, std::size_t file) {
    Json json = {{"file", file}};
    for_each_field(slice, [&](const char* name, const auto& value) { json[name] = json_of(value); });
    return json;
}

Slice slice_from(const Json& json, const std::vector<std::filesystem::path>& files) {
    Slice slice = of_file(files.at(json.at("file")));
    for_each_field(slice, [&](const char* name, auto& value) { assign(value, json.at(name)); });
    return slice;
}

// Whether GDCM's process failed, rather than this one to start it.
bool is_of_gdcm(const Error& error) { return std::string_view(error.what()).starts_with("GDCM "); }

// If GDCM crashes on one of them, each half is scanned separately, until the file is found (bisection).
void scan(const std::vector<std::filesystem::path>& files, std::vector<Slice>& all) try {
    if (files.empty()) return;
    std::size_t largest = 0;
    for (const auto& file : files) largest = std::max(largest, std::size_t(std::filesystem::file_size(file)));
    const std::size_t most = (std::size_t(1) << 28) + 4 * largest + (files.size() << 14);
    const Allowance allowance{.seconds = 5 + 0.05 * double(files.size()), .bytes = most, .output = most};
    const Written written = isolated("GDCM", files[0].string(), allowance, [&](std::FILE* out) {
        Json found = Json::array();
        for (std::size_t i = 0; i < files.size(); ++i)
            for (const Slice& slice : scan_file(files[i])) found.push_back(json_of(slice, i));
        const std::string text = found.dump(-1, ' ', false, Json::error_handler_t::replace);
        std::fwrite(text.data(), 1, text.size(), out);
    });
    const auto bytes = written.bytes();
    for (const Json& slice : Json::parse(bytes.begin(), bytes.end())) all.push_back(slice_from(slice, files));
} catch (const Error& error) {
    if (!is_of_gdcm(error)) throw;
    if (files.size() == 1) {
        all.push_back(damaged(of_file(files[0])));
        return;
    }
    const auto middle = files.begin() + std::ptrdiff_t(files.size() / 2);
    scan({files.begin(), middle}, all);
    scan({middle, files.end()}, all);
}

// ---- pixels ----

[[noreturn]] void refuse_packing(const gdcm::File& file, const std::filesystem::path& path) {
    const Slice why = packed({}, file);
    refuse(why.trouble, path, why.remedy);
}

// The pixels of all frames of a file.
struct Pixels {
    std::filesystem::path file;
    std::vector<char> bytes;
    gdcm::PixelFormat format;
    LookUpTable table;
};

Pixels read_picture(const std::filesystem::path& file) {
    gdcm::ImageReader reader;
    reader.SetFileName(file.c_str());
    if (!reader.Read()) refuse_packing(reader.GetFile(), file);
    const gdcm::Image& image = reader.GetImage();
    Pixels picture{.file = file,
                   .bytes = std::vector<char>(image.GetBufferLength()),
                   .format = image.GetPixelFormat(),
                   .table = table_of(reader.GetFile().GetDataSet(), is_signed(image.GetPixelFormat()))};
    if (!image.GetBuffer(picture.bytes.data())) refuse_packing(reader.GetFile(), file);
    // GDCM swaps the bytes of each half of a number of 32 bits, but not the halves.
    const bool turned =
        reader.GetFile().GetHeader().GetDataSetTransferSyntax() == gdcm::TransferSyntax::ExplicitVRBigEndian;
    if (turned && picture.format.GetBitsAllocated() == 32)
        for (std::size_t i = 0; i + 4 <= picture.bytes.size(); i += 4)
            std::swap_ranges(&picture.bytes[i], &picture.bytes[i] + 2, &picture.bytes[i] + 2);
    return picture;
}

// Writes the bits that are in use (BitsStored), with their sign.
template <class T>
void write_values(const Pixels& picture, const Slice& slice, std::FILE* out) {
    const std::size_t count = std::size_t(slice.size.x) * std::size_t(slice.size.y);
    if (picture.bytes.size() < (std::size_t(slice.frame) + 1) * count * sizeof(T))
        refuse("a truncated or damaged DICOM file", slice.file, "get it again, or move it away");
    const char* from = picture.bytes.data() + std::size_t(slice.frame) * count * sizeof(T);
    const int unused = std::max(int(8 * sizeof(T)) - int(picture.format.GetBitsStored()), 0);
    const int below =
        std::clamp(int(picture.format.GetHighBit()) + 1 - int(picture.format.GetBitsStored()), 0, unused);
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::make_unsigned_t<T> raw;
        std::memcpy(&raw, from + i * sizeof(T), sizeof raw);
        raw = std::make_unsigned_t<T>(raw << (unused - below));
        values[i] = float(value_of(double(T(T(raw) >> unused)), slice, picture.table));
    }
    if (std::fwrite(values.data(), sizeof(float), count, out) != count) throw std::bad_alloc();
}

void write_values(const Pixels& picture, const Slice& slice, std::FILE* out) {
    switch (picture.format.GetScalarType()) {
        case gdcm::PixelFormat::UINT8:
            return write_values<std::uint8_t>(picture, slice, out);
        case gdcm::PixelFormat::INT8:
            return write_values<std::int8_t>(picture, slice, out);
        case gdcm::PixelFormat::UINT12:
        case gdcm::PixelFormat::UINT16:
            return write_values<std::uint16_t>(picture, slice, out);
        case gdcm::PixelFormat::INT12:
        case gdcm::PixelFormat::INT16:
            return write_values<std::int16_t>(picture, slice, out);
        case gdcm::PixelFormat::UINT32:
            return write_values<std::uint32_t>(picture, slice, out);
        case gdcm::PixelFormat::INT32:
            return write_values<std::int32_t>(picture, slice, out);
        default:
            refuse("pixels of a kind that is not read", slice.file, "convert it with dcm2niix");
    }
}

void write_all(std::span<const Slice> slices, std::FILE* out) {
    Pixels picture;
    for (const Slice& slice : slices) {
        if (picture.file != slice.file) picture = read_picture(slice.file);
        write_values(picture, slice, out);
    }
}

Written pixels_of(std::span<const Slice> slices, const std::filesystem::path& path) {
    double all = 0, largest = 0;
    std::size_t values = 0;
    for (const Slice& slice : slices) {
        const auto size = double(std::filesystem::file_size(slice.file));
        all += slice.frame == 0 ? size : 0;
        largest = std::max(largest, size);
        values += std::size_t(slice.size.x) * std::size_t(slice.size.y);
    }
    constexpr double packed = 10;  // the compression ratio that is allowed for
    const Allowance allowance{.seconds = 15 + packed * std::max(all, largest) / 20e6,
                              .bytes = (std::size_t(1) << 28) + std::size_t(4 * packed * largest),
                              .output = values * sizeof(float)};
    return isolated("GDCM", path.string(), allowance, [&](std::FILE* out) { write_all(slices, out); });
}

}  // namespace

std::vector<Slice> scan(const std::vector<std::filesystem::path>& files) {
    std::vector<Slice> all;
    scan(files, all);
    return all;
}

std::vector<float> read_pixels(const std::vector<Slice>& slices, const std::filesystem::path& path) try {
    const Written written = pixels_of(slices, path);
    std::vector<float> values(written.bytes().size() / sizeof(float));
    std::memcpy(values.data(), written.bytes().data(), values.size() * sizeof(float));
    return values;
} catch (const Error& error) {
    // If it is one file that GDCM crashes on, that is the one to name.
    if (std::string_view(error.what()).starts_with("GDCM crashed"))
        for (const Slice& slice : slices) pixels_of({&slice, 1}, slice.file);
    throw;
}

}  // namespace palpate
