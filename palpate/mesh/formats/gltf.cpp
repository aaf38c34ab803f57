// glTF 2.0 as far as it tells of surfaces at rest: what places vertices is obeyed (nodes, skins, weights of
// morph targets, instances), what gives them a look is read over, and a file that requires what is not known
// here is refused. The numbers may lie as compactly as the format and its extensions allow.
#include "palpate/base/files.h"
#include "palpate/mesh/bytes.h"
#include "palpate/mesh/formats/budget.h"
#include "palpate/mesh/formats/draco.h"
#include "palpate/mesh/formats/formats.h"
#include "palpate/mesh/formats/place.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstring>
#include <map>
#include <set>
#include <utility>

namespace palpate {
namespace {

using Json = nlohmann::json;

// ---- what stands in the JSON ----

// A field of an object, or null where it has none.
const Json& field(const Json& object, std::string_view name) {
    static const Json null;
    const auto found = object.is_object() ? object.find(name) : object.end();
    return object.is_object() && found != object.end() ? *found : null;
}

const Json& extension(const Json& object, std::string_view name) {
    return field(field(object, "extensions"), name);
}

// What extensions a file may require.
constexpr std::string_view draco = "KHR_draco_mesh_compression", meshopt = "EXT_meshopt_compression",
                           instancing = "EXT_mesh_gpu_instancing",
                           texture_transform = "KHR_texture_transform", visibility = "KHR_node_visibility";
constexpr std::string_view understood_extensions[] = {
    draco, meshopt, instancing, texture_transform, visibility, "KHR_mesh_quantization"};
constexpr std::string_view only_looks[] = {
    "KHR_materials_", "KHR_texture_", "EXT_texture_",   "MSFT_texture_",        "KHR_lights_",
    "EXT_lights_",    "KHR_xmp",      "KHR_animation_", "KHR_techniques_webgl", "KHR_technique_webgl"};

bool may_be_required(std::string_view name) {
    return std::ranges::count(understood_extensions, name) > 0 ||
           std::ranges::any_of(only_looks, [&](std::string_view start) { return name.starts_with(start); });
}

// ---- numbers ----

struct Kind {
    int number;  // glTF's
    std::size_t bytes;
    double (*load)(const char* from);
    double most;  // what stands for 1 where numbers are normalised
};

template <class T>
double load(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return double(value);
}

constexpr Kind kinds[] = {{5120, 1, load<std::int8_t>, 127},
                          {5121, 1, load<std::uint8_t>, 255},
                          {5122, 2, load<std::int16_t>, 32767},
                          {5123, 2, load<std::uint16_t>, 65535},
                          {5125, 4, load<std::uint32_t>, 0xffffffffp0},
                          {5126, 4, load<float>, 0}};

constexpr std::pair<std::string_view, std::size_t> shapes[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};

// Numbers of T's kind, one behind the other, as T.
template <class T>
std::vector<T> packed(const std::vector<double>& numbers) {
    std::vector<T> values(numbers.size() * sizeof(double) / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), numbers.data(), values.size() * sizeof(T));
    return values;
}

template <class T>
constexpr std::string_view shape_of = sizeof(T) == 16   ? "VEC2"
                                      : sizeof(T) == 24 ? "VEC3"
                                                        : "VEC4";

dmat3 turn_by(glm::dvec4 quaternion) {  // of any length
    const dvec3 axis(quaternion);
    return turn_about(axis, 2 * std::atan2(glm::length(axis), quaternion.w));
}

Place place_of(const double* matrix) {  // column by column
    const auto column = [&](int k) { return dvec3(matrix[4 * k], matrix[4 * k + 1], matrix[4 * k + 2]); };
    return {dmat3(column(0), column(1), column(2)), column(3)};
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

// ---- the file ----

class Gltf {
 public:
    explicit Gltf(Source source) : source_(std::move(source)), budget_(source_) {}

    Draft read() {
        open();
        if (is_of_version_1()) return read_with_assimp(source_);
        check_extensions();
        unpack_all_of_draco();
        place_nodes();
        if (list("nodes").empty())  // a library of meshes
            for (std::size_t i = 0; i < list("meshes").size(); ++i) add_mesh({{"mesh", i}}, Place());
        else
            walk(roots());
        if (!has_normals_) draft_.normals.clear();
        if (!has_uvs_ && !draft_.uvs.empty())
            draft_.notes.push_back("left the texture coordinates out: some parts have none");
        if (!has_uvs_) draft_.uvs.clear();
        if (hidden_ > 0)
            draft_.notes.push_back(fmt::format(
                "left out {} nodes that are not visible (KHR_node_visibility), with what hangs on them",
                hidden_));
        if (unfinished_ > 0)
            draft_.notes.push_back(
                fmt::format("left out {} corners that make no whole triangle", unfinished_));
        if (uncopied_ > 0)
            draft_.notes.push_back(fmt::format(
                "left out the copies (EXT_mesh_gpu_instancing) of {} meshes with a skin", uncopied_));
        return std::move(draft_);
    }

 private:
    [[noreturn]] void broken(std::string_view what) const { source_.broken(what); }

    // --- the container ---

    // The JSON, and the binary part that a GLB has behind it.
    void open() {
        std::string_view text = source_.whole();
        if (text.starts_with("glTF")) {
            text = open_glb(text);
        } else {
            source_.skip_mark();
            text = source_.rest;
        }
        json_ = Json::parse(text, nullptr, false);
        if (json_.is_discarded()) broken("JSON that is damaged or truncated");
        if (!json_.is_object()) broken("JSON that is no glTF");
    }

    // Returns its JSON.
    std::string_view open_glb(std::string_view file) {
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

    bool is_of_version_1() const {
        if (field(json_, "meshes").is_object()) return true;  // where version 2 has lists
        const Json& version = field(field(json_, "asset"), "version");
        const std::string_view text =
            version.is_string() ? std::string_view(version.get_ref<const std::string&>()) : "2.0";
        if (!text.starts_with("1") && !text.starts_with("2"))
            broken("glTF of the version " + in_quotes(text));
        return text.starts_with("1");
    }

    void check_extensions() const {
        for (const Json& name : list("extensionsRequired")) {
            if (!name.is_string()) broken("a required extension without a name");
            const std::string_view text = name.get_ref<const std::string&>();
            if (!may_be_required(text))
                source_.broken("a glTF that cannot be understood without the extension " + in_quotes(text) +
                                   ", which is not read,",
                               "export it without that");
        }
    }

    // --- fields ---

    // A list of the file's; empty where there is none.
    const Json& list(std::string_view name) const { return list_of(json_, name); }

    const Json& list_of(const Json& object, std::string_view name) const {
        static const Json none = Json::array();
        const Json& found = field(object, name);
        if (found.is_null()) return none;
        if (!found.is_array()) broken(fmt::format("\"{}\" that is no list", name));
        return found;
    }

    // A whole number that is not negative; `fallback` where there is nothing.
    std::size_t whole(const Json& value, std::string_view what, std::size_t fallback) const {
        if (value.is_null()) return fallback;
        if (!value.is_number() || !is_whole(value.get<double>(), 0, 0x1p53))
            broken(fmt::format("{} that is no whole number", what));
        return std::size_t(value.get<double>());
    }

    // The entry of a list that a number names.
    std::size_t number_in(std::string_view name, const Json& number) const {
        const std::size_t count = list(name).size(),
                          i = whole(number, "a number in " + std::string(name), count);
        if (i >= count) broken(fmt::format("number {} in {}, of which there are {},", i, name, count));
        return i;
    }
    const Json& entry(std::string_view name, const Json& number) const {
        return list(name)[number_in(name, number)];
    }

    // N numbers of a node or of a texture; what is given where there are none.
    template <std::size_t N>
    std::array<double, N> numbers(const Json& object, std::string_view name,
                                  std::array<double, N> values) const {
        const Json& all = list_of(object, name);
        if (all.empty()) return values;
        const auto is_number = [](const Json& n) { return n.is_number(); };
        if (all.size() != N || !std::ranges::all_of(all, is_number))
            broken(fmt::format("a {} that is not {} numbers", name, N));
        for (std::size_t k = 0; k < N; ++k) values[k] = all[k].get<double>();
        return values;
    }

    // --- bytes ---

    std::string_view buffer(std::size_t number) {
        const Json& uri = field(list("buffers")[number], "uri");
        if (uri.is_null() && number == 0 && binary_) return *binary_;
        if (!uri.is_string()) broken(fmt::format("buffer {}, which is nowhere,", number));
        const auto [known, is_new] = buffers_.try_emplace(number);
        if (!is_new) return known->second;
        const std::string_view text = uri.get_ref<const std::string&>();
        known->second = text.starts_with("data:") ? inside(text) : outside(text);
        return known->second;
    }

    static std::string inside(std::string_view uri) {
        const std::string_view head = until(',', uri);
        return head.ends_with(";base64") ? from_base64(uri) : percent_decoded(uri);
    }

    // A file adds to the budget once, however many buffers name it; each of them has its bytes anew.
    std::string outside(std::string_view uri) {
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

    // The bytes of a buffer view, and how far apart the entries in it are; 0: without gaps.
    struct View {
        std::string_view bytes;
        std::size_t stride;
    };

    // What an offset and a length cut out of a buffer.
    std::string_view cut(const Json& of) {
        const std::string_view bytes = buffer(number_in("buffers", field(of, "buffer")));
        const std::size_t offset = whole(field(of, "byteOffset"), "an offset", 0),
                          length = whole(field(of, "byteLength"), "a length", 0);
        if (offset > bytes.size() || length > bytes.size() - offset)
            broken(fmt::format("bytes {} to {} of a buffer of {}: truncated", offset, offset + length,
                               bytes.size()));
        return bytes.substr(offset, length);
    }

    View view(const Json& which) {
        const std::size_t number = number_in("bufferViews", which);
        const Json& view = list("bufferViews")[number];
        const Json& packing = extension(view, meshopt);
        if (packing.is_null()) return {cut(view), whole(field(view, "byteStride"), "a stride", 0)};
        const auto [known, is_new] = unpacked_.try_emplace(number);
        const std::size_t stride = whole(field(packing, "byteStride"), "a stride", 0);
        if (is_new) known->second = unpack(packing, stride);
        return {known->second, stride};
    }

    // meshoptimizer's decoders write as much as they are told and no more.
    std::string unpack(const Json& packing, std::size_t stride) {
        const std::string_view bytes = cut(packing);
        const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
        const std::size_t count = whole(field(packing, "count"), "a count", 0);
        const std::string mode = text(packing, "mode", ""), filter = text(packing, "filter", "NONE");
        if (stride == 0 || stride > 256) broken("a stride in meshopt's compression that cannot be");
        const bool vertices = mode == "ATTRIBUTES";
        if (vertices && stride % 4 != 0)
            broken(
                fmt::format("a stride of {} in meshopt's compression, which is no multiple of 4,", stride));
        if (!vertices && (mode != "TRIANGLES" || count % 3 != 0) && mode != "INDICES")
            broken("an unknown mode of meshopt's compression, " + in_quotes(mode) + ",");
        if (!vertices && stride != 2 && stride != 4) broken("indices of an impossible size");
        const std::size_t filled = (count + 3) / 4 * 4;  // the filters may work on four at once
        budget_.spend(filled, stride);
        std::string made(filled * stride, '\0');
        const int failed = vertices
                               ? meshopt_decodeVertexBuffer(made.data(), count, stride, from, bytes.size())
                           : mode == "TRIANGLES"
                               ? meshopt_decodeIndexBuffer(made.data(), count, stride, from, bytes.size())
                               : meshopt_decodeIndexSequence(made.data(), count, stride, from, bytes.size());
        if (failed != 0) broken("damaged meshopt compression");
        if (filter == "OCTAHEDRAL" && vertices && (stride == 4 || stride == 8))
            meshopt_decodeFilterOct(made.data(), filled, stride);
        else if (filter == "QUATERNION" && vertices && stride == 8)
            meshopt_decodeFilterQuat(made.data(), filled, stride);
        else if (filter == "EXPONENTIAL" && vertices)
            meshopt_decodeFilterExp(made.data(), filled, stride);
        else if (filter != "NONE")
            broken("an unknown filter of meshopt's compression, " + in_quotes(filter) + ",");
        made.resize(count * stride);
        return made;
    }

    static std::string text(const Json& object, std::string_view name, std::string_view fallback) {
        const Json& value = field(object, name);
        return value.is_string() ? value.get<std::string>() : std::string(fallback);
    }

    // Draco's meshes, for which the accessors of a primitive have no bytes of their own.
    void unpack_all_of_draco() {
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
                    packed.back().attributes.push_back(
                        std::uint32_t(whole(id, "an attribute of Draco's", 0)));
                }
            }
        std::vector<DracoMesh> meshes = unpack_draco(packed, source_, budget_.left());
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            draco_corners_[primitives[i]] = std::move(meshes[i].corners);
            for (std::size_t k = 0; k < accessors[i].size(); ++k)
                draco_numbers_[accessors[i][k]] = std::move(meshes[i].attributes[k]);
        }
    }

    // --- accessors ---

    static const Kind* kind_of(const Json& number) {
        const auto found = std::ranges::find_if(
            kinds, [&](const Kind& kind) { return number.is_number_integer() && number == kind.number; });
        return found == std::end(kinds) ? nullptr : found;
    }

    // `count` times `components` numbers, from an offset of a view.
    std::vector<double> numbers_in(const Json& where, const Kind& kind, std::size_t count,
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

    // All numbers of an accessor.
    std::vector<double> numbers_of(const Json& which, std::string_view shape) {
        const std::size_t number = number_in("accessors", which);
        const Json& accessor = list("accessors")[number];
        const Kind* const kind = kind_of(field(accessor, "componentType"));
        if (!kind) broken("an unknown kind of numbers");
        if (text(accessor, "type", "") != shape)
            broken(fmt::format("{} where {} should be", in_quotes(text(accessor, "type", "")), shape));
        const std::size_t count = whole(field(accessor, "count"), "a count", 0),
                          components = std::ranges::find(shapes, shape,
                                                         &std::pair<std::string_view, std::size_t>::first)
                                           ->second;
        std::vector<double> numbers;
        if (const auto known = draco_numbers_.find(number); known != draco_numbers_.end()) {
            if (known->second.size() != count * components)
                broken("another number of vertices in what Draco packed");
            budget_.spend(count, components * sizeof(double));
            numbers = known->second;
        } else if (!field(accessor, "bufferView").is_null()) {
            numbers = numbers_in(accessor, *kind, count, components);
        } else {
            budget_.spend(count, components * sizeof(double));
            numbers.assign(count * components, 0);
        }
        if (const Json& sparse = field(accessor, "sparse"); !sparse.is_null())
            replace(numbers, sparse, *kind, components);
        if (field(accessor, "normalized") == Json(true) && kind->most > 0)
            for (double& n : numbers) n = std::max(n / kind->most, -1.0);
        return numbers;
    }

    template <class T>
    std::vector<T> vectors_of(const Json& accessor) {
        return packed<T>(numbers_of(accessor, shape_of<T>));
    }

    // A sparse accessor gives some of its entries anew.
    void replace(std::vector<double>& numbers, const Json& sparse, const Kind& kind, std::size_t components) {
        const std::size_t count = whole(field(sparse, "count"), "a count", 0);
        const Kind* const index = kind_of(field(field(sparse, "indices"), "componentType"));
        if (!index) broken("an unknown kind of numbers");
        const std::vector<double> places = numbers_in(field(sparse, "indices"), *index, count, 1),
                                  values = numbers_in(field(sparse, "values"), kind, count, components);
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_whole(places[i], 0, double(numbers.size() / components) - 1))
                broken(fmt::format("a sparse accessor naming entry {} of {}", places[i],
                                   numbers.size() / components));
            std::copy_n(values.begin() + std::ptrdiff_t(i * components), components,
                        numbers.begin() + std::ptrdiff_t(std::size_t(places[i]) * components));
        }
    }

    // --- nodes ---

    Place own_place(const Json& node) const {
        if (!list_of(node, "matrix").empty()) return place_of(numbers<16>(node, "matrix", {}).data());
        const auto [x, y, z] = numbers<3>(node, "translation", {0, 0, 0});
        const auto [a, b, c, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
        const auto [u, v, t] = numbers<3>(node, "scale", {1, 1, 1});
        return {turn_by({a, b, c, w}) * scale_by({u, v, t}), {x, y, z}};
    }

    // Where each node stands in the world.
    void place_nodes() {
        const Json& nodes = list("nodes");
        worlds_.resize(nodes.size());
        hangs_.assign(nodes.size(), false);
        for (const Json& node : nodes)
            for (const Json& child : list_of(node, "children")) {
                const std::size_t number = number_in("nodes", child);
                if (hangs_[number]) broken(fmt::format("node {}, which hangs on two others", number));
                hangs_[number] = true;
            }
        std::vector<std::size_t> left;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            worlds_[i] = own_place(nodes[i]);
            if (!hangs_[i]) left.push_back(i);
        }
        std::size_t placed = 0;
        for (; !left.empty(); ++placed) {
            const std::size_t i = left.back();
            left.pop_back();
            for (const Json& child : list_of(nodes[i], "children")) {
                const std::size_t number = number_in("nodes", child);
                worlds_[number] = worlds_[i] * worlds_[number];
                left.push_back(number);
            }
        }
        if (placed < nodes.size()) broken("nodes that hang on themselves");
    }

    // What the file shows: the nodes of its scene, or all.
    std::vector<std::size_t> roots() {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < hangs_.size(); ++i)
            if (!hangs_[i]) found.push_back(i);
        const Json& scenes = list("scenes");
        if (scenes.empty()) return found;
        std::vector<std::size_t> shown =
            roots_of(entry("scenes", whole(field(json_, "scene"), "a scene", 0)));
        for (std::size_t i = 0; i < scenes.size() && !shows_mesh(shown); ++i)
            if (shown = roots_of(scenes[i]); shows_mesh(shown))
                draft_.notes.push_back(fmt::format(
                    "read scene {}, counted from 0, because the one that the file shows has no mesh", i));
        if (!shows_mesh(shown)) {
            draft_.notes.push_back("read all nodes, because no scene has a mesh");
            return found;
        }
        if (scenes.size() > 1)
            draft_.notes.push_back(
                fmt::format("left out {} scenes beside the one that is read", scenes.size() - 1));
        return shown;
    }

    std::vector<std::size_t> roots_of(const Json& scene) const {
        std::vector<std::size_t> roots;
        for (const Json& node : list_of(scene, "nodes")) roots.push_back(number_in("nodes", node));
        return roots;
    }

    // Whether a mesh hangs on one of these nodes or below.
    bool shows_mesh(std::vector<std::size_t> left) const {
        std::vector<bool> seen(worlds_.size());
        while (!left.empty()) {
            const std::size_t i = left.back();
            left.pop_back();
            if (seen[i]) continue;
            seen[i] = true;
            const Json& node = list("nodes")[i];
            if (!field(node, "mesh").is_null()) return true;
            for (const Json& child : list_of(node, "children")) left.push_back(number_in("nodes", child));
        }
        return false;
    }

    // Adds all meshes on these nodes and below them, in the order in which they stand.
    void walk(std::vector<std::size_t> left) {
        std::ranges::reverse(left);
        std::vector<bool> seen(worlds_.size());
        while (!left.empty()) {
            const std::size_t i = left.back();
            left.pop_back();
            if (seen[i]) continue;
            seen[i] = true;
            const Json& node = list("nodes")[i];
            if (field(extension(node, visibility), "visible") == Json(false)) {
                ++hidden_;
                continue;
            }
            if (!field(node, "mesh").is_null())
                for (const Place& instance : instances(node)) add_mesh(node, worlds_[i] * instance);
            const Json& children = list_of(node, "children");
            for (std::size_t k = children.size(); k-- > 0;) left.push_back(number_in("nodes", children[k]));
        }
    }

    std::vector<Place> instances(const Json& node) {
        const Json& extra = extension(node, instancing);
        if (extra.is_null()) return {Place()};
        if (!field(node, "skin").is_null()) {
            ++uncopied_;
            return {Place()};
        }
        const Json &given = field(extra, "attributes"), &move = field(given, "TRANSLATION"),
                   &turn = field(given, "ROTATION"), &scale = field(given, "SCALE");
        const auto moves = move.is_null() ? std::vector<dvec3>() : vectors_of<dvec3>(move);
        const auto turns = turn.is_null() ? std::vector<glm::dvec4>() : vectors_of<glm::dvec4>(turn);
        const auto scales = scale.is_null() ? std::vector<dvec3>() : vectors_of<dvec3>(scale);
        const std::size_t count = std::max({moves.size(), turns.size(), scales.size()});
        for (std::size_t each : {moves.size(), turns.size(), scales.size()})
            if (each != 0 && each != count) broken("instances with places of different number");
        std::vector<Place> places(std::max<std::size_t>(count, 1));
        for (std::size_t i = 0; i < count; ++i) {
            if (!turns.empty()) places[i].turn = turn_by(turns[i]);
            if (!scales.empty()) places[i].turn = places[i].turn * scale_by(scales[i]);
            if (!moves.empty()) places[i].move = moves[i];
        }
        return places;
    }

    // --- meshes ---

    // Vertices that primitives may share.
    struct Vertices {
        Index first = 0;
        std::size_t count = 0;
        bool mirrored = false;
    };

    // What it costs to look at a primitive once more, for each node and each instance that has it.
    static constexpr std::size_t bytes_a_visit = 100, bytes_a_letter = 16;

    void add_mesh(const Json& node, const Place& world) {
        const Json& mesh = entry("meshes", field(node, "mesh"));
        const Json& weights =
            field(node, "weights").is_null() ? list_of(mesh, "weights") : list_of(node, "weights");
        const std::vector<Place> bones = bones_of(node);
        std::map<std::string, Vertices> known;
        for (const Json& primitive : list_of(mesh, "primitives")) {
            budget_.spend(bytes_a_visit);
            const Json& attributes = field(primitive, "attributes");
            const Json& positions = field(attributes, "POSITION");
            if (positions.is_null()) continue;  // for an extension to fill
            std::string name = identity(primitive);
            budget_.spend(name.size(), bytes_a_letter);
            const auto [at, is_new] = known.try_emplace(std::move(name));
            if (is_new) at->second = add_vertices(primitive, weights, world, bones);
            add_faces(primitive, at->second);
        }
    }

    // Primitives for which this is the same have the same vertices.
    std::string identity(const Json& primitive) const {
        std::string text;
        const auto add = [&](const Json& attributes) {
            if (attributes.is_object())
                for (const auto& [name, number] : attributes.items())
                    text += fmt::format("{} {} ", name, whole(number, name, 0));
            text += '\n';
        };
        add(field(primitive, "attributes"));
        for (const Json& target : list_of(primitive, "targets")) add(target);
        const auto [set, place] = picture_of(primitive);
        return text + fmt::format("{} {} {} {} {} {} {}", set, place.turn[0].x, place.turn[0].y,
                                  place.turn[1].x, place.turn[1].y, place.move.x, place.move.y);
    }

    // Where the joints of a node's skin carry what hangs on them; empty if it has none. The node itself then
    // places nothing.
    std::vector<Place> bones_of(const Json& node) {
        if (field(node, "skin").is_null()) return {};
        const Json& skin = entry("skins", field(node, "skin"));
        const Json& joints = list_of(skin, "joints");
        const Json& inverse = field(skin, "inverseBindMatrices");
        const std::vector<double> matrices =
            inverse.is_null() ? std::vector<double>() : numbers_of(inverse, "MAT4");
        if (joints.empty() || (!inverse.is_null() && matrices.size() < 16 * joints.size()))
            broken("a skin with fewer matrices than joints");
        budget_.spend(joints.size(), sizeof(Place));
        std::vector<Place> bones;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const Place bind = inverse.is_null() ? Place() : place_of(&matrices[16 * i]);
            bones.push_back(worlds_[number_in("nodes", joints[i])] * bind);
        }
        return bones;
    }

    Vertices add_vertices(const Json& primitive, const Json& weights, const Place& world,
                          const std::vector<Place>& bones) {
        const Json& attributes = field(primitive, "attributes");
        std::vector<dvec3> positions = at_rest<dvec3>(primitive, "POSITION", weights, 0);
        const std::size_t count = positions.size();
        if (draft_.positions.size() + count > ~Index(0)) broken("more than 2^32 vertices");
        std::vector<dvec3> normals = at_rest<dvec3>(primitive, "NORMAL", weights, count);
        const auto [set, in_picture] = picture_of(primitive);
        std::vector<dvec2> uvs = at_rest<dvec2>(primitive, set, weights, count);
        if (too_far_for_floats(positions)) draft_.single = true;

        Vertices added{Index(draft_.positions.size()), count, world.mirrors()};
        const bool carries = !bones.empty() && !field(attributes, "JOINTS_0").is_null();
        const std::vector<Place> carried = carries ? carry(attributes, bones, count) : std::vector<Place>();
        if (carries) added.mirrored = mostly_mirrored(carried);
        for (std::size_t i = 0; i < count; ++i) {
            const Place& place = carries ? carried[i] : world;
            draft_.positions.push_back(place.of(positions[i]));
            if (!normals.empty()) draft_.normals.push_back(place.normal(normals[i]));
        }
        for (dvec2 uv : uvs) {
            const dvec3 turned = in_picture.of({uv, 0});
            draft_.uvs.push_back({turned.x, 1 - turned.y});  // glTF counts down
        }
        has_normals_ = has_normals_ && normals.size() == count;
        has_uvs_ = has_uvs_ && uvs.size() == count;
        return added;
    }

    // An attribute with what morph targets add to it; nothing if there is none.
    template <class T>
    std::vector<T> at_rest(const Json& primitive, const std::string& name, const Json& weights,
                           std::size_t count) {
        const Json& which = field(field(primitive, "attributes"), name);
        if (which.is_null()) return {};
        std::vector<T> values = vectors_of<T>(which);
        const auto must_fit = [&](const std::vector<T>& list) {
            if (count > 0 && list.size() != count)
                broken(fmt::format("{} of {} for {} vertices", list.size(), name, count));
        };
        must_fit(values);
        const Json& targets = list_of(primitive, "targets");
        for (std::size_t k = 0; k < std::min(targets.size(), weights.size()); ++k) {
            const Json& moves = field(targets[k], name);
            const double weight = weights[k].is_number() ? weights[k].get<double>() : 0;
            if (weight == 0 || moves.is_null()) continue;
            const std::vector<T> ways = vectors_of<T>(moves);
            if (ways.size() != values.size()) broken("a morph target of another number of vertices");
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * ways[i];
        }
        return values;
    }

    // Where the joints carry each vertex; the first of them, one that is on none.
    std::vector<Place> carry(const Json& attributes, const std::vector<Place>& bones, std::size_t count) {
        budget_.spend(count, sizeof(Place));
        MeanPlaces places(count);
        for (int set = 0;; ++set) {
            const Json& joints = field(attributes, fmt::format("JOINTS_{}", set));
            const Json& shares = field(attributes, fmt::format("WEIGHTS_{}", set));
            if (joints.is_null() || shares.is_null()) break;
            const auto on = vectors_of<glm::dvec4>(joints), by = vectors_of<glm::dvec4>(shares);
            if (on.size() != count || by.size() != count) broken("a skin of another number of vertices");
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < 4; ++k) {
                    if (by[i][k] == 0) continue;
                    if (!is_whole(on[i][k], 0, double(bones.size()) - 1))
                        broken(fmt::format("a vertex on joint {} of {}", on[i][k], bones.size()));
                    places.add(i, bones[std::size_t(on[i][k])], by[i][k]);
                }
        }
        return std::move(places).take(bones[0]);
    }

    // Which texture coordinates a primitive's picture takes, and where they are turned to.
    struct Picture {
        std::string set = "TEXCOORD_0";
        Place place{};
    };

    Picture picture_of(const Json& primitive) const {
        if (field(primitive, "material").is_null()) return {};
        const Json& material = entry("materials", field(primitive, "material"));
        const Json& texture = field(field(material, "pbrMetallicRoughness"), "baseColorTexture");
        const Json& by = extension(texture, texture_transform);
        const Json& set = field(field(by, "texCoord").is_null() ? texture : by, "texCoord");
        const auto [x, y] = numbers<2>(by, "offset", {0, 0});
        const auto [u, v] = numbers<2>(by, "scale", {1, 1});
        const Json& angle = field(by, "rotation");
        const dmat3 turn = turn_about({0, 0, 1}, angle.is_number() ? -angle.get<double>() : 0);
        return {fmt::format("TEXCOORD_{}", whole(set, "a set of texture coordinates", 0)),
                {turn * scale_by({u, v, 1}), {x, y, 0}}};
    }

    void add_faces(const Json& primitive, const Vertices& vertices) {
        std::vector<double> corners;
        const auto unpacked = draco_corners_.find(&primitive);
        if (unpacked != draco_corners_.end()) {
            budget_.spend(unpacked->second.size(), sizeof(double));
            corners = unpacked->second;
        } else if (const Json& indices = field(primitive, "indices"); !indices.is_null()) {
            corners = numbers_of(indices, "SCALAR");
        } else {
            budget_.spend(vertices.count, sizeof(double));
            for (std::size_t i = 0; i < vertices.count; ++i) corners.push_back(double(i));
        }
        for (double corner : corners)
            if (!is_whole(corner, 0, double(vertices.count) - 1))
                broken(fmt::format("a face naming vertex {} of {}, counted from 0,", corner, vertices.count));
        const std::size_t n = corners.size(), mode = unpacked != draco_corners_.end()
                                                         ? 4
                                                         : whole(field(primitive, "mode"), "a mode", 4);
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (vertices.mirrored) std::swap(a, c);
            for (std::size_t k : {a, b, c}) draft_.corners.push_back(vertices.first + Index(corners[k]));
            draft_.sizes.push_back(3);
        };
        const auto add_unless_flat = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (corners[a] != corners[b] && corners[b] != corners[c] && corners[c] != corners[a])
                add(a, b, c);
        };
        budget_.spend(mode == 4 ? n : 3 * n, 2 * sizeof(Index));
        switch (mode) {
            case 0:
                draft_.loose += n;
                break;  // points
            case 1:
                draft_.loose += n / 2;
                break;  // lines
            case 2:
                draft_.loose += n;
                break;  // a ring of them
            case 3:
                draft_.loose += n > 0 ? n - 1 : 0;
                break;  // a row of them
            case 4:
                for (std::size_t i = 0; i + 2 < n; i += 3) add(i, i + 1, i + 2);
                unfinished_ += n % 3;
                break;
            case 5:  // a strip, whose repeated corners only lead to its next part
                for (std::size_t i = 0; i + 2 < n; ++i) add_unless_flat(i, i + 1 + i % 2, i + 2 - i % 2);
                break;
            case 6:  // a fan
                for (std::size_t i = 1; i + 1 < n; ++i) add_unless_flat(i, i + 1, 0);
                break;
            default:
                broken(fmt::format("the unknown mode {} of a primitive", mode));
        }
    }

    Source source_;
    Budget budget_;
    Json json_;
    std::optional<std::string_view> binary_;
    std::set<std::filesystem::path> files_;                     // others, that buffers name
    std::map<std::size_t, std::string> buffers_, unpacked_;     // by number, as far as they are asked for
    std::map<std::size_t, std::vector<double>> draco_numbers_;  // of accessors
    std::map<const Json*, std::vector<double>> draco_corners_;  // of primitives
    std::vector<Place> worlds_;                                 // of nodes
    std::vector<bool> hangs_;                                   // nodes, on others
    bool has_normals_ = true, has_uvs_ = true;                  // all parts so far
    std::size_t unfinished_ = 0, uncopied_ = 0, hidden_ = 0;
    Draft draft_;
};

}  // namespace

Draft read_gltf(Source source) { return Gltf(std::move(source)).read(); }

}  // namespace palpate
