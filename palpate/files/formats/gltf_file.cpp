#include "palpate/files/formats/gltf_file.h"

#include "palpate/base/files.h"
#include "palpate/base/vectors.h"
#include "palpate/files/bytes.h"
#include "palpate/files/formats/draco.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace palpate {
namespace {

template <class T>
double load(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return double(value);
}

constexpr struct {
    std::string_view name;
    std::size_t components;
} shapes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};

std::size_t components_of(std::string_view shape) {  // one that is known
    return std::ranges::find_if(shapes, [&](const auto& s) { return s.name == shape; })->components;
}

template <class Vector>
constexpr std::string_view shape_of = shapes[Vector::length() - 1].name;

// Consecutive numbers as vectors T.
template <class T>
std::vector<T> packed(const std::vector<double>& numbers) {
    std::vector<T> values(numbers.size() * sizeof(double) / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), numbers.data(), values.size() * sizeof(T));
    return values;
}

std::string from_base64(std::string_view text) {
    std::string bytes;
    unsigned bits = 0;
    int there = 0;
    for (char c : text) {
        const std::size_t digit = base64_digits.find(c == '-' ? '+' : c == '_' ? '/' : c);
        if (digit == std::string_view::npos) continue;  // = at the end, spaces
        bits = bits << 6 | unsigned(digit);
        if ((there += 6) >= 8) bytes += char(bits >> (there -= 8));
    }
    return bytes;
}

std::string inside(std::string_view uri) {
    const std::string_view head = until(',', uri);
    return head.ends_with(";base64") ? from_base64(uri) : percent_decoded(uri);
}

std::string text_of(const nlohmann::json& object, std::string_view name, std::string_view fallback) {
    const nlohmann::json& value = field(object, name);
    return value.is_string() ? value.get<std::string>() : std::string(fallback);
}

// Reverses a filter that meshopt applied to vertices before compression. False if the filter is unknown.
bool undo_filter(std::string_view filter, std::string& vertices, std::size_t stride) {
    const std::size_t count = vertices.size() / stride;
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(vertices.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(vertices.data(), count, stride);
    else if (filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(vertices.data(), count, stride);
    else
        return false;
    return true;
}

}  // namespace

const nlohmann::json& field(const nlohmann::json& object, std::string_view name) {
    static const nlohmann::json null;
    const auto found = object.find(name);
    return found == object.end() ? null : *found;
}

const nlohmann::json& extension(const nlohmann::json& object, std::string_view name) {
    return field(field(object, "extensions"), name);
}

// ---- the container ----

GltfFile::GltfFile(Source source) : source_(std::move(source)), budget_(source_) {
    std::string_view text = source_.whole();
    if (text.starts_with("glTF")) {
        text = open_glb(text);
    } else {
        source_.skip_mark();
        text = source_.rest;
    }
    json_ = Json::parse(text, nullptr, false);
    if (json_.is_discarded()) broken("JSON that is damaged or truncated");
    if (!json_.is_object()) broken("JSON that is not glTF");
}

// Returns its JSON.
std::string_view GltfFile::open_glb(std::string_view file) {
    const auto word = [&](std::size_t at) {
        return at + 4 <= file.size() ? std::size_t(load<std::uint32_t>(file.data() + at)) : 0;
    };
    if (word(4) == 1) return R"({"asset": {"version": "1.0"}})";  // that is all that matters here
    if (word(8) > file.size())
        broken(fmt::format("{} bytes promised and {} there: truncated", word(8), file.size()));
    std::string_view text;
    for (std::size_t at = 12; at + 8 <= word(8); at += 8 + word(at)) {
        if (word(at) > word(8) - at - 8) broken("a part that is longer than the file");
        const std::string_view part = file.substr(at + 8, word(at)), kind = file.substr(at + 4, 4);
        if (kind == "JSON" && text.empty()) text = part;
        if (kind == std::string_view("BIN\0", 4) && !binary_) binary_ = part;
    }
    return text;
}

bool GltfFile::is_of_version_1() const {
    if (field(json_, "meshes").is_object()) return true;  // where version 2 has lists
    const Json& version = field(field(json_, "asset"), "version");
    const std::string_view text =
        version.is_string() ? std::string_view(version.get_ref<const std::string&>()) : "2.0";
    if (!text.starts_with("1") && !text.starts_with("2")) broken("glTF of the version " + in_quotes(text));
    return text.starts_with("1");
}

// ---- the JSON ----

const GltfFile::Json& GltfFile::list_of(const Json& object, std::string_view name) const {
    static const Json none = Json::array();
    const Json& found = field(object, name);
    if (found.is_null()) return none;
    if (!found.is_array()) broken(fmt::format("\"{}\" that is not a list", name));
    return found;
}

std::size_t GltfFile::whole(const Json& value, std::string_view what, std::size_t fallback) const {
    if (value.is_null()) return fallback;
    if (!value.is_number() || !is_whole(value.get<double>(), 0, 0x1p53))
        broken(fmt::format("{} that is not a whole number", what));
    return std::size_t(value.get<double>());
}

std::size_t GltfFile::number_in(std::string_view name, const Json& number) const {
    const std::size_t count = list(name).size(), i = whole(number, "a number in " + std::string(name), count);
    if (i >= count) broken(fmt::format("number {} in {}, of which there are {},", i, name, count));
    return i;
}

// ---- bytes ----

std::string_view GltfFile::buffer(std::size_t number) {
    const Json& uri = field(list("buffers")[number], "uri");
    if (uri.is_null() && number == 0 && binary_) return *binary_;
    if (!uri.is_string()) broken(fmt::format("buffer {}, which has no data,", number));
    const auto [known, is_new] = buffers_.try_emplace(number);
    if (!is_new) return known->second;
    const std::string_view text = uri.get_ref<const std::string&>();
    known->second = text.starts_with("data:") ? inside(text) : outside(text);
    return known->second;
}

// A file adds to the budget once, however many buffers name it; each buffer has its own copy.
std::string GltfFile::outside(std::string_view uri) {
    const auto file = source_.beside(uri);
    if (!file)
        source_.broken(
            "the name of another file, " + in_quotes(uri) + ", which is not in its folder or below,",
            "put it there, or export it as one .glb");
    std::string text = read_text(*file);
    if (files_.insert(std::filesystem::canonical(*file)).second) budget_.add_file(text.size());
    budget_.spend(text.size());
    return text;
}

// The part of a buffer with this offset and length.
std::string_view GltfFile::cut(const Json& of) {
    const std::string_view bytes = buffer(number_in("buffers", field(of, "buffer")));
    const std::size_t offset = whole(field(of, "byteOffset"), "an offset", 0),
                      length = whole(field(of, "byteLength"), "a length", 0);
    if (offset > bytes.size() || length > bytes.size() - offset)
        broken(fmt::format("bytes {} to {} of a buffer of {}: truncated", offset, offset + length,
                           bytes.size()));
    return bytes.substr(offset, length);
}

GltfFile::View GltfFile::view(const Json& which) {
    const std::size_t number = number_in("bufferViews", which);
    const Json& view = list("bufferViews")[number];
    const Json& packing = extension(view, meshopt);
    if (packing.is_null()) return {cut(view), whole(field(view, "byteStride"), "a stride", 0)};
    const auto [known, is_new] = unpacked_.try_emplace(number);
    const std::size_t stride = whole(field(packing, "byteStride"), "a stride", 0);
    if (is_new) known->second = unpack(packing, stride);
    return {known->second, stride};
}

// meshoptimizer's decoders never write more than the given size.
std::string GltfFile::unpack(const Json& packing, std::size_t stride) {
    const std::string_view bytes = cut(packing);
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const std::size_t count = whole(field(packing, "count"), "a count", 0);
    const std::string mode = text_of(packing, "mode", ""), filter = text_of(packing, "filter", "NONE");
    if (stride == 0 || stride > 256) broken("an invalid stride in meshopt's compression");
    const bool vertices = mode == "ATTRIBUTES";
    if (vertices && stride % 4 != 0)
        broken(fmt::format("a stride of {} in meshopt's compression, which is not a multiple of 4,", stride));
    if (!vertices && (mode != "TRIANGLES" || count % 3 != 0) && mode != "INDICES")
        broken("an unknown mode of meshopt's compression, " + in_quotes(mode) + ",");
    if (!vertices && stride != 2 && stride != 4) broken("indices of an impossible size");
    const std::size_t filled = (count + 3) / 4 * 4;  // the filters may work on four at once
    budget_.spend(filled, stride);
    std::string made(filled * stride, '\0');
    const int failed = vertices ? meshopt_decodeVertexBuffer(made.data(), count, stride, from, bytes.size())
                       : mode == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(made.data(), count, stride, from, bytes.size())
                           : meshopt_decodeIndexSequence(made.data(), count, stride, from, bytes.size());
    if (failed != 0) broken("damaged meshopt compression");
    if (filter != "NONE" && !(vertices && undo_filter(filter, made, stride)))
        broken("an unknown filter of meshopt's compression, " + in_quotes(filter) + ",");
    made.resize(count * stride);
    return made;
}

void GltfFile::unpack_draco() {
    std::vector<const Json*> primitives;
    std::vector<std::vector<std::size_t>> accessors;
    std::vector<DracoPacked> packed;
    for (const Json& mesh : list("meshes"))
        for (const Json& primitive : list_of(mesh, "primitives")) {
            const Json& extra = extension(primitive, draco);
            if (extra.is_null()) continue;
            primitives.push_back(&primitive);
            accessors.emplace_back();
            packed.push_back({view(field(extra, "bufferView")).bytes, {}});
            if (!field(extra, "attributes").is_object()) continue;
            for (const auto& [name, id] : field(extra, "attributes").items()) {
                const Json& accessor = field(field(primitive, "attributes"), name);
                if (accessor.is_null()) continue;
                accessors.back().push_back(number_in("accessors", accessor));
                packed.back().attributes.push_back(std::uint32_t(whole(id, "an attribute of Draco's", 0)));
            }
        }
    std::vector<DracoMesh> meshes = palpate::unpack_draco(packed, source_, budget_.left());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        draco_corners_[primitives[i]] = std::move(meshes[i].corners);
        for (std::size_t k = 0; k < accessors[i].size(); ++k)
            draco_numbers_[accessors[i][k]] = std::move(meshes[i].attributes[k]);
    }
}

const std::vector<double>* GltfFile::draco_corners(const Json& primitive) const {
    const auto found = draco_corners_.find(&primitive);
    return found == draco_corners_.end() ? nullptr : &found->second;
}

// ---- accessors ----

// A kind of numbers.
struct GltfFile::Kind {
    int number;  // glTF's
    std::size_t bytes;
    double (*load)(const char* from);
    double most;  // represents 1 if numbers are normalised
};

const GltfFile::Kind& GltfFile::kind_of(const Json& number) const {
    static constexpr Kind kinds[] = {{5120, 1, load<std::int8_t>, 127},
                                     {5121, 1, load<std::uint8_t>, 255},
                                     {5122, 2, load<std::int16_t>, 32767},
                                     {5123, 2, load<std::uint16_t>, 65535},
                                     {5125, 4, load<std::uint32_t>, 0xffffffffp0},
                                     {5126, 4, load<float>, 0}};
    const auto found = std::ranges::find_if(
        kinds, [&](const Kind& kind) { return number.is_number_integer() && number == kind.number; });
    if (found == std::end(kinds)) broken("an unknown kind of numbers");
    return *found;
}

// `count` times `components` numbers, from an offset of a view.
std::vector<double> GltfFile::numbers_in(const Json& where, const Kind& kind, std::size_t count,
                                         std::size_t components) {
    const View from = view(field(where, "bufferView"));
    const std::size_t offset = whole(field(where, "byteOffset"), "an offset", 0),
                      each = components * kind.bytes, stride = from.stride > 0 ? from.stride : each,
                      there = from.bytes.size();
    if (count > 0 &&
        (offset > there || each > there - offset || count - 1 > (there - offset - each) / stride))
        broken(fmt::format("{} entries promised in {} bytes: truncated", count, there));
    budget_.spend(count, components * sizeof(double));
    std::vector<double> numbers;
    numbers.reserve(count * components);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < components; ++k)
            numbers.push_back(kind.load(from.bytes.data() + offset + i * stride + k * kind.bytes));
    return numbers;
}

std::vector<double> GltfFile::numbers_of(const Json& which, std::string_view shape) {
    if (which.is_null()) return {};
    const std::size_t number = number_in("accessors", which);
    const Json& accessor = list("accessors")[number];
    const Kind& kind = kind_of(field(accessor, "componentType"));
    if (const std::string found = text_of(accessor, "type", ""); found != shape)
        broken(fmt::format("{} where {} should be", in_quotes(found), shape));
    const std::size_t count = whole(field(accessor, "count"), "a count", 0),
                      components = components_of(shape);
    std::vector<double> numbers;
    if (const auto known = draco_numbers_.find(number); known != draco_numbers_.end()) {
        if (known->second.size() != count * components)
            broken("a Draco mesh with another number of vertices");
        budget_.spend(count, components * sizeof(double));
        numbers = known->second;
    } else if (!field(accessor, "bufferView").is_null()) {
        numbers = numbers_in(accessor, kind, count, components);
    } else {
        budget_.spend(count, components * sizeof(double));
        numbers.assign(count * components, 0);
    }
    if (const Json& sparse = field(accessor, "sparse"); !sparse.is_null())
        replace(numbers, sparse, kind, components);
    if (field(accessor, "normalized") == Json(true) && kind.most > 0)
        for (double& n : numbers) n = std::max(n / kind.most, -1.0);
    return numbers;
}

template <class T>
std::vector<T> GltfFile::vectors_of(const Json& accessor) {
    return packed<T>(numbers_of(accessor, shape_of<T>));
}
template std::vector<dvec2> GltfFile::vectors_of(const Json& accessor);
template std::vector<dvec3> GltfFile::vectors_of(const Json& accessor);
template std::vector<glm::dvec4> GltfFile::vectors_of(const Json& accessor);

// A sparse accessor replaces some of its entries.
void GltfFile::replace(std::vector<double>& numbers, const Json& sparse, const Kind& kind,
                       std::size_t components) {
    const std::size_t count = whole(field(sparse, "count"), "a count", 0);
    const Kind& index = kind_of(field(field(sparse, "indices"), "componentType"));
    const std::vector<double> places = numbers_in(field(sparse, "indices"), index, count, 1),
                              values = numbers_in(field(sparse, "values"), kind, count, components);
    for (std::size_t i = 0; i < count; ++i) {
        if (!is_whole(places[i], 0, double(numbers.size() / components) - 1))
            broken(fmt::format("a sparse accessor naming entry {} of {}", places[i],
                               numbers.size() / components));
        std::copy_n(values.begin() + std::ptrdiff_t(i * components), components,
                    numbers.begin() + std::ptrdiff_t(std::size_t(places[i]) * components));
    }
}

}  // namespace palpate
