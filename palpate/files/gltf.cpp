#include "palpate/files/gltf.h"

#include "palpate/base/error.h"
#include "palpate/files/bytes.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Constants of glTF.
constexpr int float_numbers = 5126, index_numbers = 5125, vertex_buffer = 34962, index_buffer = 34963;

OrderedJson array(vec3 v) { return {v.x, v.y, v.z}; }

// The lists of a file. Each function appends an entry and returns its index.
struct Lists {
    OrderedJson views = OrderedJson::array(), accessors = OrderedJson::array();
    std::uint64_t end = 0;  // of the views so far, bytes

    int view(std::uint64_t bytes, OrderedJson more = OrderedJson::object()) {
        more["buffer"] = 0;
        more["byteOffset"] = end;
        more["byteLength"] = bytes;
        end += bytes;
        views.push_back(std::move(more));
        return int(views.size()) - 1;
    }
    int accessor(int view, std::uint64_t offset, int numbers, std::size_t count, const char* type) {
        accessors.push_back({{"bufferView", view},
                             {"byteOffset", offset},
                             {"componentType", numbers},
                             {"count", count},
                             {"type", type}});
        return int(accessors.size()) - 1;
    }
    int vectors(int view, std::uint64_t offset, std::size_t count) {
        return accessor(view, offset, float_numbers, count, "VEC3");
    }
    int positions(int view, std::uint64_t offset, std::size_t count, const Bounds& box) {
        const int number = vectors(view, offset, count);
        accessors.back()["min"] = array(box.low);
        accessors.back()["max"] = array(box.high);
        return number;
    }
};

// Positions, followed by normals, at an offset of a view.
OrderedJson attributes(const GltfContents& contents, Lists& lists, int view, std::uint64_t offset,
                       const Bounds& box) {
    OrderedJson json;
    json["POSITION"] = lists.positions(view, offset, contents.vertices, box);
    if (contents.normals)
        json["NORMAL"] = lists.vectors(view, offset + 12 * contents.vertices, contents.vertices);
    return json;
}

OrderedJson animation(const GltfContents& contents, Lists& lists) {
    const std::size_t pictures = contents.times.size();
    const int times = lists.accessor(lists.view(4 * pictures), 0, float_numbers, pictures, "SCALAR");
    lists.accessors.back()["min"] = {contents.times.front()};
    lists.accessors.back()["max"] = {contents.times.back()};
    const int weights =
        lists.accessor(lists.view(4 * pictures * pictures), 0, float_numbers, pictures * pictures, "SCALAR");
    return {{"name", "run"},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
            {"samplers", {{{"input", times}, {"interpolation", "LINEAR"}, {"output", weights}}}}};
}

std::string base64(const std::string& bytes) {
    std::string text;
    text.reserve(bytes.size() / 3 * 4 + 4);
    auto byte = [&](std::size_t i) { return i < bytes.size() ? std::uint32_t(std::uint8_t(bytes[i])) : 0u; };
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::uint32_t word = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (int shift : {18, 12, 6, 0}) text += base64_digits[word >> shift & 63];
    }
    for (std::size_t left = bytes.size() % 3, i = 0; left && i < 3 - left; ++i)
        text[text.size() - 1 - i] = '=';
    return text;
}

}  // namespace

vec3 gltf_normal(vec3 normal) {
    const float length = glm::length(normal);
    if (std::abs(length - 1) < 1e-4f) return normal;
    return length > 0 && std::isfinite(length) ? normal / length : vec3(0, 0, 1);
}

GltfContents gltf_contents(const Mesh& mesh, const std::string& file) {
    if (mesh.triangles.empty() || mesh.positions.empty())
        throw Error("no triangles, and glTF needs at least one", file, "use .ply");
    GltfContents contents{
        mesh.positions.size(), mesh.triangles.size(), !mesh.normals.empty(), bounds(mesh), {}, {}};
    if (contents.rest_bytes() > gltf_limit)
        throw Error("a mesh of more than 2 GB", file, "use .ply, or simplify it");
    return contents;
}

std::string gltf_binary(const Mesh& mesh) {
    std::string bytes;
    append_all<uvec3>(bytes, mesh.triangles);
    append_all<vec3>(bytes, mesh.positions);
    for (vec3 n : mesh.normals) append(bytes, gltf_normal(n));
    return bytes;
}

std::string gltf_json(const GltfContents& contents, const std::string& uri) {
    Lists lists;
    const int triangles = lists.view(12 * contents.faces, {{"target", index_buffer}});
    const OrderedJson vertices = {{"byteStride", 12}, {"target", vertex_buffer}};
    const int rest = lists.view(contents.picture_bytes(), vertices);
    OrderedJson primitive;
    primitive["attributes"] = attributes(contents, lists, rest, 0, contents.box);
    primitive["indices"] = lists.accessor(triangles, 0, index_numbers, 3 * contents.faces, "SCALAR");
    OrderedJson mesh;
    OrderedJson animations;
    if (const std::size_t pictures = contents.times.size()) {
        const int moved = lists.view(pictures * contents.picture_bytes(), vertices);
        for (std::size_t i = 0; i < pictures; ++i)
            primitive["targets"].push_back(
                attributes(contents, lists, moved, i * contents.picture_bytes(), contents.moves[i]));
        mesh["weights"] = std::vector<int>(pictures, 0);
        animations.push_back(animation(contents, lists));
    }
    mesh["primitives"].push_back(std::move(primitive));

    OrderedJson file = {{"asset", {{"version", "2.0"}, {"generator", "Palpate"}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", {0}}}}},
                        {"nodes", {{{"mesh", 0}}}}};
    file["meshes"].push_back(std::move(mesh));
    if (!animations.empty()) file["animations"] = std::move(animations);
    file["accessors"] = std::move(lists.accessors);
    file["bufferViews"] = std::move(lists.views);
    file["buffers"].push_back({{"byteLength", lists.end}});
    if (!uri.empty()) file["buffers"][0]["uri"] = uri;
    return file.dump();
}

std::string glb_head(const GltfContents& contents) {
    std::string json = gltf_json(contents);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto binary = std::uint32_t(contents.bytes(contents.times.size()));
    std::string head = "glTF";
    append(head, std::uint32_t{2});
    append(head, std::uint32_t(12 + 8 + json.size() + 8 + binary));
    append(head, std::uint32_t(json.size()));
    head += "JSON" + json;
    append(head, binary);
    head.append("BIN\0", 4);
    return head;
}

std::string glb(const Mesh& mesh, const std::string& file) {
    return glb_head(gltf_contents(mesh, file)) + gltf_binary(mesh);
}

std::string gltf(const Mesh& mesh, const std::string& file) {
    const GltfContents contents = gltf_contents(mesh, file);
    return gltf_json(contents, "data:application/octet-stream;base64," + base64(gltf_binary(mesh)));
}

}  // namespace palpate
