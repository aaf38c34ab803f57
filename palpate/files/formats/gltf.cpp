// The surfaces of a glTF 2.0 file at rest. Everything that places vertices is applied (nodes, skins, weights
// of morph targets, instances), appearance is ignored, and a file that requires an unknown extension is
// refused.
#include "palpate/base/error.h"
#include "palpate/files/formats/formats.h"
#include "palpate/files/formats/gltf_file.h"
#include "palpate/files/formats/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

using Json = nlohmann::json;

// What extensions a file may require.
constexpr std::string_view instancing = "EXT_mesh_gpu_instancing",
                           texture_transform = "KHR_texture_transform", visibility = "KHR_node_visibility";
constexpr std::string_view understood_extensions[] = {
    GltfFile::draco, GltfFile::meshopt, instancing, texture_transform, visibility, "KHR_mesh_quantization"};
constexpr std::string_view only_looks[] = {
    "KHR_materials_", "KHR_texture_", "EXT_texture_",   "MSFT_texture_",        "KHR_lights_",
    "EXT_lights_",    "KHR_xmp",      "KHR_animation_", "KHR_techniques_webgl", "KHR_technique_webgl"};

bool may_be_required(std::string_view name) {
    return std::ranges::count(understood_extensions, name) > 0 ||
           std::ranges::any_of(only_looks, [&](std::string_view start) { return name.starts_with(start); });
}

dmat3 rotation_by(glm::dvec4 quaternion) {  // of any length
    const dvec3 axis(quaternion);
    return rotation_about(axis, 2 * std::atan2(glm::length(axis), quaternion.w));
}

Transform transform_of(const double* matrix) {  // column by column
    const auto column = [&](int k) { return dvec3(matrix[4 * k], matrix[4 * k + 1], matrix[4 * k + 2]); };
    return {dmat3(column(0), column(1), column(2)), column(3)};
}

class Gltf {
 public:
    explicit Gltf(Source source) : file_(std::move(source)) {}

    Draft read() {
        if (file_.is_of_version_1()) return read_with_assimp(file_.source());
        check_extensions();
        file_.unpack_draco();
        place_nodes();
        if (file_.list("nodes").empty())  // a library of meshes
            for (std::size_t i = 0; i < file_.list("meshes").size(); ++i)
                add_mesh({{"mesh", i}}, Transform());
        else
            add_meshes();
        leave_out();
        return std::move(draft_);
    }

 private:
    [[noreturn]] void broken(std::string_view what) const { file_.broken(what); }

    void check_extensions() const {
        for (const Json& name : file_.list("extensionsRequired")) {
            if (!name.is_string()) broken("a required extension without a name");
            const std::string_view text = name.get_ref<const std::string&>();
            if (!may_be_required(text))
                file_.source().broken(
                    "a glTF that requires the extension " + in_quotes(text) + ", which is not read,",
                    "export it without that");
        }
    }

    // N numbers of a node or of a texture; `values` if it has none.
    template <std::size_t N>
    std::array<double, N> numbers(const Json& object, std::string_view name,
                                  std::array<double, N> values) const {
        const Json& all = file_.list_of(object, name);
        if (all.empty()) return values;
        const auto is_number = [](const Json& n) { return n.is_number(); };
        if (all.size() != N || !std::ranges::all_of(all, is_number))
            broken(fmt::format("a {} that is not {} numbers", name, N));
        for (std::size_t k = 0; k < N; ++k) values[k] = all[k].get<double>();
        return values;
    }

    // --- nodes ---

    Transform own_transform(const Json& node) const {
        if (!file_.list_of(node, "matrix").empty())
            return transform_of(numbers<16>(node, "matrix", {}).data());
        const auto [x, y, z] = numbers<3>(node, "translation", {0, 0, 0});
        const auto [a, b, c, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
        const auto [u, v, t] = numbers<3>(node, "scale", {1, 1, 1});
        return {rotation_by({a, b, c, w}) * scaling_by({u, v, t}), {x, y, z}};
    }

    // The indices of nodes in one of an object's lists.
    std::vector<std::size_t> nodes_in(const Json& object, std::string_view name) const {
        std::vector<std::size_t> nodes;
        for (const Json& node : file_.list_of(object, name)) nodes.push_back(file_.number_in("nodes", node));
        return nodes;
    }

    // Visits these nodes and their descendants, each once and in order, but not the descendants of a node for
    // which `visit` returns false.
    template <class Visit>
    void walk(std::vector<std::size_t> left, const Visit& visit) const {
        std::ranges::reverse(left);
        std::vector<bool> seen(file_.list("nodes").size());
        while (!left.empty()) {
            const std::size_t i = left.back();
            left.pop_back();
            if (seen[i]) continue;
            seen[i] = true;
            const Json& node = file_.list("nodes")[i];
            if (!visit(i, node)) continue;
            const std::vector<std::size_t> children = nodes_in(node, "children");
            left.insert(left.end(), children.rbegin(), children.rend());
        }
    }

    // Computes the world transforms of all nodes.
    void place_nodes() {
        const Json& nodes = file_.list("nodes");
        std::vector<bool> has_parent(nodes.size());
        for (const Json& node : nodes)
            for (std::size_t child : nodes_in(node, "children")) {
                if (has_parent[child]) broken(fmt::format("node {}, which has two parents,", child));
                has_parent[child] = true;
            }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            worlds_.push_back(own_transform(nodes[i]));
            if (!has_parent[i]) tops_.push_back(i);
        }
        std::size_t placed = 0;
        walk(tops_, [&](std::size_t i, const Json& node) {
            ++placed;
            for (std::size_t child : nodes_in(node, "children")) worlds_[child] = worlds_[i] * worlds_[child];
            return true;
        });
        if (placed < nodes.size()) broken("a cycle of nodes");
    }

    // The roots of the file's default scene, or of another scene with a mesh, or of all nodes.
    std::vector<std::size_t> roots() {
        const Json& scenes = file_.list("scenes");
        if (scenes.empty()) return tops_;
        std::vector<std::size_t> shown =
            nodes_in(file_.entry("scenes", file_.whole(field(file_.json(), "scene"), "a scene", 0)), "nodes");
        for (std::size_t i = 0; i < scenes.size() && !shows_mesh(shown); ++i)
            if (shown = nodes_in(scenes[i], "nodes"); shows_mesh(shown))
                draft_.notes.push_back(fmt::format(
                    "read scene {}, counted from 0, because the one that the file shows has no mesh", i));
        if (!shows_mesh(shown)) {
            draft_.notes.push_back("read all nodes, because no scene has a mesh");
            return tops_;
        }
        if (scenes.size() > 1)
            draft_.notes.push_back(
                fmt::format("left out {} beside the one that is read", counted(scenes.size() - 1, "scene")));
        return shown;
    }

    // Whether one of these nodes or their descendants has a mesh.
    bool shows_mesh(const std::vector<std::size_t>& roots) const {
        bool found = false;
        walk(roots, [&](std::size_t, const Json& node) {
            found = found || !field(node, "mesh").is_null();
            return !found;
        });
        return found;
    }

    // The transforms of a node's instances, relative to the node.
    std::vector<Transform> instances(const Json& node) {
        const Json& extra = extension(node, instancing);
        if (extra.is_null()) return {Transform()};
        if (!field(node, "skin").is_null()) {
            ++uncopied_;
            return {Transform()};
        }
        const Json& given = field(extra, "attributes");
        const auto moves = file_.vectors_of<dvec3>(field(given, "TRANSLATION"));
        const auto turns = file_.vectors_of<glm::dvec4>(field(given, "ROTATION"));
        const auto scales = file_.vectors_of<dvec3>(field(given, "SCALE"));
        const std::size_t count = std::max({moves.size(), turns.size(), scales.size()});
        for (std::size_t each : {moves.size(), turns.size(), scales.size()})
            if (each != 0 && each != count) broken("instances whose attributes differ in number");
        std::vector<Transform> transforms(std::max<std::size_t>(count, 1));
        for (std::size_t i = 0; i < count; ++i) {
            if (!turns.empty()) transforms[i].linear = rotation_by(turns[i]);
            if (!scales.empty()) transforms[i].linear = transforms[i].linear * scaling_by(scales[i]);
            if (!moves.empty()) transforms[i].translation = moves[i];
        }
        return transforms;
    }

    // --- meshes ---

    // Vertices that primitives may share.
    struct Vertices {
        Index first = 0;
        std::size_t count = 0;
        bool mirrored = false;
    };

    // The charge for visiting a primitive again, for each node and each instance that has it.
    static constexpr std::size_t bytes_a_visit = 100, bytes_a_letter = 16;

    void add_meshes() {
        walk(roots(), [&](std::size_t i, const Json& node) {
            const bool hidden = field(extension(node, visibility), "visible") == Json(false);
            if (hidden)
                ++hidden_;
            else if (!field(node, "mesh").is_null())
                for (const Transform& instance : instances(node)) add_mesh(node, worlds_[i] * instance);
            return !hidden;
        });
    }

    void add_mesh(const Json& node, const Transform& world) {
        const Json& mesh = file_.entry("meshes", field(node, "mesh"));
        const Json& weights = field(node, "weights").is_null() ? file_.list_of(mesh, "weights")
                                                               : file_.list_of(node, "weights");
        const std::vector<Transform> bones = bones_of(node);
        std::map<std::string, Vertices> known;
        for (const Json& primitive : file_.list_of(mesh, "primitives")) {
            file_.spend(bytes_a_visit);
            const Json& attributes = field(primitive, "attributes");
            const Json& positions = field(attributes, "POSITION");
            if (positions.is_null()) continue;  // for an extension to fill
            std::string name = identity(primitive);
            file_.spend(name.size(), bytes_a_letter);
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
                    text += fmt::format("{} {} ", name, file_.whole(number, name, 0));
            text += '\n';
        };
        add(field(primitive, "attributes"));
        for (const Json& target : file_.list_of(primitive, "targets")) add(target);
        const auto [set, transform] = texture_of(primitive);
        return text + fmt::format("{} {} {} {} {} {} {}", set, transform.linear[0].x, transform.linear[0].y,
                                  transform.linear[1].x, transform.linear[1].y, transform.translation.x,
                                  transform.translation.y);
    }

    // The transforms by the joints of a node's skin, which replace that of the node; empty if it has no skin.
    std::vector<Transform> bones_of(const Json& node) {
        if (field(node, "skin").is_null()) return {};
        const Json& skin = file_.entry("skins", field(node, "skin"));
        const Json& joints = file_.list_of(skin, "joints");
        const Json& inverse = field(skin, "inverseBindMatrices");
        const std::vector<double> matrices = file_.numbers_of(inverse, "MAT4");
        if (joints.empty() || (!inverse.is_null() && matrices.size() < 16 * joints.size()))
            broken("a skin with fewer matrices than joints");
        file_.spend(joints.size(), sizeof(Transform));
        std::vector<Transform> bones;
        for (std::size_t joint : nodes_in(skin, "joints")) {
            const Transform bind =
                inverse.is_null() ? Transform() : transform_of(&matrices[16 * bones.size()]);
            bones.push_back(worlds_[joint] * bind);
        }
        return bones;
    }

    Vertices add_vertices(const Json& primitive, const Json& weights, const Transform& world,
                          const std::vector<Transform>& bones) {
        const Json& attributes = field(primitive, "attributes");
        std::vector<dvec3> positions = at_rest<dvec3>(primitive, "POSITION", weights, 0);
        const std::size_t count = positions.size();
        if (draft_.positions.size() + count > ~Index(0)) broken("more than 2^32 vertices");
        std::vector<dvec3> normals = at_rest<dvec3>(primitive, "NORMAL", weights, count);
        const auto [set, in_texture] = texture_of(primitive);
        std::vector<dvec2> uvs = at_rest<dvec2>(primitive, set, weights, count);
        if (too_far_for_floats(positions)) draft_.single = true;

        Vertices added{Index(draft_.positions.size()), count, world.mirrors()};
        const bool is_skinned = !bones.empty() && !field(attributes, "JOINTS_0").is_null();
        const std::vector<Transform> skinned =
            is_skinned ? skin(attributes, bones, count) : std::vector<Transform>();
        if (is_skinned) added.mirrored = mostly_mirror(skinned);
        for (std::size_t i = 0; i < count; ++i) {
            const Transform& transform = is_skinned ? skinned[i] : world;
            draft_.positions.push_back(transform.of(positions[i]));
            if (!normals.empty()) draft_.normals.push_back(transform.normal(normals[i]));
        }
        for (dvec2 uv : uvs) {
            const dvec3 placed = in_texture.of({uv, 0});
            draft_.uvs.push_back({placed.x, 1 - placed.y});  // glTF's v points down
        }
        has_normals_ = has_normals_ && normals.size() == count;
        has_uvs_ = has_uvs_ && uvs.size() == count;
        return added;
    }

    // An attribute with its morph targets added by weight; empty if it is missing.
    template <class T>
    std::vector<T> at_rest(const Json& primitive, const std::string& name, const Json& weights,
                           std::size_t count) {
        const Json& which = field(field(primitive, "attributes"), name);
        if (which.is_null()) return {};
        std::vector<T> values = file_.vectors_of<T>(which);
        if (count > 0 && values.size() != count)
            broken(fmt::format("{} of {} for {} vertices", values.size(), name, count));
        const Json& targets = file_.list_of(primitive, "targets");
        for (std::size_t k = 0; k < std::min(targets.size(), weights.size()); ++k) {
            const Json& moves = field(targets[k], name);
            const double weight = weights[k].is_number() ? weights[k].get<double>() : 0;
            if (weight == 0 || moves.is_null()) continue;
            const std::vector<T> ways = file_.vectors_of<T>(moves);
            if (ways.size() != values.size()) broken("a morph target with another number of vertices");
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * ways[i];
        }
        return values;
    }

    // The skinning transform of each vertex; that of the first joint for a vertex without joints.
    std::vector<Transform> skin(const Json& attributes, const std::vector<Transform>& bones,
                                std::size_t count) {
        file_.spend(count, sizeof(Transform));
        MeanTransforms transforms(count);
        for (int set = 0;; ++set) {
            const Json& joints = field(attributes, fmt::format("JOINTS_{}", set));
            const Json& shares = field(attributes, fmt::format("WEIGHTS_{}", set));
            if (joints.is_null() || shares.is_null()) break;
            const auto on = file_.vectors_of<glm::dvec4>(joints), by = file_.vectors_of<glm::dvec4>(shares);
            if (on.size() != count || by.size() != count) broken("a skin with another number of vertices");
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < 4; ++k) {
                    if (by[i][k] == 0) continue;
                    if (!is_whole(on[i][k], 0, double(bones.size()) - 1))
                        broken(fmt::format("a vertex on joint {} of {}", on[i][k], bones.size()));
                    transforms.add(i, bones[std::size_t(on[i][k])], by[i][k]);
                }
        }
        return std::move(transforms).take(bones[0]);
    }

    // Which texture coordinates a primitive's texture takes, and their transform.
    struct Texture {
        std::string set = "TEXCOORD_0";
        Transform transform{};
    };

    Texture texture_of(const Json& primitive) const {
        if (field(primitive, "material").is_null()) return {};
        const Json& material = file_.entry("materials", field(primitive, "material"));
        const Json& texture = field(field(material, "pbrMetallicRoughness"), "baseColorTexture");
        const Json& by = extension(texture, texture_transform);
        const Json& set = field(field(by, "texCoord").is_null() ? texture : by, "texCoord");
        const auto [x, y] = numbers<2>(by, "offset", {0, 0});
        const auto [u, v] = numbers<2>(by, "scale", {1, 1});
        const Json& angle = field(by, "rotation");
        const dmat3 turn = rotation_about({0, 0, 1}, angle.is_number() ? -angle.get<double>() : 0);
        return {fmt::format("TEXCOORD_{}", file_.whole(set, "a set of texture coordinates", 0)),
                {turn * scaling_by({u, v, 1}), {x, y, 0}}};
    }

    // The corners of a primitive's faces, as numbers of its vertices.
    std::vector<double> corners_of(const Json& primitive, std::size_t vertices) {
        std::vector<double> corners;
        if (const auto* unpacked = file_.draco_corners(primitive)) {
            file_.spend(unpacked->size(), sizeof(double));
            corners = *unpacked;
        } else if (const Json& indices = field(primitive, "indices"); !indices.is_null()) {
            corners = file_.numbers_of(indices, "SCALAR");
        } else {
            file_.spend(vertices, sizeof(double));
            corners.resize(vertices);
            std::iota(corners.begin(), corners.end(), 0.0);
        }
        for (double corner : corners)
            if (!is_whole(corner, 0, double(vertices) - 1))
                broken(fmt::format("a face naming vertex {} of {}, counted from 0,", corner, vertices));
        return corners;
    }

    void add_faces(const Json& primitive, const Vertices& vertices) {
        const std::vector<double> corners = corners_of(primitive, vertices.count);
        const std::size_t n = corners.size(), triangles = 4,
                          mode = file_.draco_corners(primitive)
                                     ? triangles
                                     : file_.whole(field(primitive, "mode"), "a mode", triangles);
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (vertices.mirrored) std::swap(a, c);
            for (std::size_t k : {a, b, c}) draft_.corners.push_back(vertices.first + Index(corners[k]));
            draft_.sizes.push_back(3);
        };
        const auto add_unless_flat = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (corners[a] != corners[b] && corners[b] != corners[c] && corners[c] != corners[a])
                add(a, b, c);
        };
        file_.spend(mode == triangles ? n : 3 * n, 2 * sizeof(Index));
        switch (mode) {
            case 0:  // points
            case 2:  // a line loop
                draft_.loose += n;
                break;
            case 1:  // lines
                draft_.loose += n / 2;
                break;
            case 3:  // a line strip
                draft_.loose += n > 0 ? n - 1 : 0;
                break;
            case triangles:
                for (std::size_t i = 0; i + 2 < n; i += 3) add(i, i + 1, i + 2);
                unfinished_ += n % 3;
                break;
            case 5:  // a strip; degenerate triangles only connect its parts
                for (std::size_t i = 0; i + 2 < n; ++i) add_unless_flat(i, i + 1 + i % 2, i + 2 - i % 2);
                break;
            case 6:  // a fan
                for (std::size_t i = 1; i + 1 < n; ++i) add_unless_flat(i, i + 1, 0);
                break;
            default:
                broken(fmt::format("the unknown mode {} of a primitive", mode));
        }
    }

    // Drops attributes that some parts lack, and notes everything that was left out.
    void leave_out() {
        const auto note = [&](std::size_t count, fmt::format_string<std::string> text, const char* one) {
            if (count > 0) draft_.notes.push_back(fmt::format(text, counted(count, one)));
        };
        if (!has_normals_) draft_.normals.clear();
        if (!has_uvs_ && !draft_.uvs.empty())
            draft_.notes.push_back("left the texture coordinates out: some parts have none");
        if (!has_uvs_) draft_.uvs.clear();
        note(hidden_, "left out {} (KHR_node_visibility), with everything below", "invisible node");
        note(unfinished_, "left out {} beyond the last whole triangle", "corner");
        note(uncopied_, "left out the copies (EXT_mesh_gpu_instancing) of {}", "skinned surface");
    }

    GltfFile file_;
    std::vector<Transform> worlds_;             // of nodes
    std::vector<std::size_t> tops_;             // nodes without a parent
    bool has_normals_ = true, has_uvs_ = true;  // all parts so far
    std::size_t unfinished_ = 0, uncopied_ = 0, hidden_ = 0;
    Draft draft_;
};

}  // namespace

Draft read_gltf(Source source) { return Gltf(std::move(source)).read(); }

}  // namespace palpate
