#include "palpate/mesh/write.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/ending.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little, "the PLY below is written as it lies in memory");

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string ply(const Mesh& mesh) {
    const bool normals = !mesh.normals.empty();
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment in metres, written by Palpate\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}element face {}\n"
        "property list uchar uint vertex_indices\nend_header\n",
        mesh.positions.size(), normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        mesh.triangles.size());
    text.reserve(text.size() + 24 * mesh.positions.size() + 13 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append(text, mesh.positions[i]);
        if (normals) append(text, mesh.normals[i]);
    }
    for (uvec3 t : mesh.triangles) {
        append(text, std::uint8_t{3});
        append(text, t);
    }
    return text;
}

std::string obj(const Mesh& mesh) {
    std::string text = "# in metres, written by Palpate\n";
    auto out = std::back_inserter(text);
    // Nine digits tell every float from its neighbours.
    for (vec3 p : mesh.positions) fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    for (vec3 n : mesh.normals) fmt::format_to(out, "vn {:.9g} {:.9g} {:.9g}\n", n.x, n.y, n.z);
    for (uvec3 t : mesh.triangles) {
        uvec3 n = t + 1u;
        if (mesh.normals.empty())
            fmt::format_to(out, "f {} {} {}\n", n.x, n.y, n.z);
        else
            fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", n.x, n.y, n.z);
    }
    return text;
}

}  // namespace

void check_mesh_name(const std::filesystem::path& path) {
    const std::string format = ending(path);
    if (format != ".ply" && format != ".obj")
        throw Error("cannot write the mesh format \"" + format + "\"", path.string(), "use .ply or .obj");
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path) {
    assert(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    check_mesh_name(path);
    write_text(path, ending(path) == ".ply" ? ply(mesh) : obj(mesh));
}

}  // namespace palpate
