#include "palpate/files/write.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/bytes.h"
#include "palpate/files/extension.h"
#include "palpate/files/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>

namespace palpate {
namespace {

std::string ply(const Mesh& mesh, const VertexValues& values, const std::string&) {
    const bool normals = !mesh.normals.empty(), valued = !values.values.empty();
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment in metres, written by Palpate\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}{}element face {}\n"
        "property list uchar uint vertex_indices\nend_header\n",
        mesh.positions.size(), normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        valued ? fmt::format("property float {}\n", values.name) : "", mesh.triangles.size());
    text.reserve(text.size() + 28 * mesh.positions.size() + 13 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append(text, mesh.positions[i]);
        if (normals) append(text, mesh.normals[i]);
        if (valued) append(text, values.values[i]);
    }
    for (uvec3 t : mesh.triangles) {
        append(text, std::uint8_t{3});
        append(text, t);
    }
    return text;
}

std::string obj(const Mesh& mesh, const std::string&) {
    std::string text = "# in metres, written by Palpate\n";
    auto out = std::back_inserter(text);
    // Nine digits distinguish every float from its neighbours.
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

// The face normal; zero if the face is degenerate. In double, so that no product of floats underflows.
vec3 face_normal(dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    return length > 0 ? vec3(across / length) : vec3(0);
}

std::string stl(const Mesh& mesh, const std::string&) {
    std::string bytes = "Palpate: binary STL, in metres";  // "solid" would say that text follows
    bytes.reserve(84 + 50 * mesh.triangles.size());
    bytes.resize(80, ' ');
    append(bytes, std::uint32_t(mesh.triangles.size()));
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        for (vec3 v : {face_normal(a, b, c), a, b, c}) append(bytes, v);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

// Each block of numbers follows its length, and the XML has its offset.
std::string vtp(const Mesh& mesh, const VertexValues& values, const std::string& file) {
    if (mesh.triangles.size() > std::numeric_limits<std::int32_t>::max() / 3)
        throw Error("too many triangles for VTK's 32-bit numbers", file, "use .ply, or simplify it");
    std::string blocks;
    auto array = [&]<class T>(const char* type, std::string_view name, int components,
                              std::span<const T> numbers) {
        const std::size_t begins = blocks.size();
        append(blocks, std::uint64_t(numbers.size_bytes()));
        append_all(blocks, numbers);
        return fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
            "format=\"appended\" offset=\"{}\"/>\n",
            type, name, components, begins);
    };
    std::vector<std::int32_t> ends;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) ends.push_back(std::int32_t(3 * (f + 1)));
    const std::string points = array("Float32", "Points", 3, std::span<const vec3>(mesh.positions));
    const std::string normals =
        mesh.normals.empty() ? "" : array("Float32", "Normals", 3, std::span<const vec3>(mesh.normals));
    const std::string valued = values.values.empty() ? "" : array("Float32", values.name, 1, values.values);
    const std::string corners = array("Int32", "connectivity", 1, std::span<const uvec3>(mesh.triangles)) +
                                array("Int32", "offsets", 1, std::span<const std::int32_t>(ends));
    const std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- in metres, written by Palpate -->\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
        "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n"
        "<Points>\n{}</Points>\n<PointData Normals=\"Normals\">\n{}{}</PointData>\n<Polys>\n{}</Polys>\n"
        "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
        mesh.positions.size(), mesh.triangles.size(), points, normals, valued, corners);
    return text + blocks + "\n</AppendedData>\n</VTKFile>\n";
}

// Of a format without values of vertices.
template <std::string (*text)(const Mesh&, const std::string&)>
std::string without(const Mesh& mesh, const VertexValues&, const std::string& file) {
    return text(mesh, file);
}

struct Format {
    std::string_view extension;
    std::string (*text)(const Mesh& mesh, const VertexValues& values, const std::string& file);
};
constexpr Format formats[] = {{".ply", ply}, {".obj", without<obj>}, {".stl", without<stl>},
                              {".vtp", vtp}, {".glb", without<glb>}, {".gltf", without<gltf>}};

const Format& format_of(const std::filesystem::path& path) {
    const std::string wanted = extension(path);
    const auto* found = std::find_if(std::begin(formats), std::end(formats),
                                     [&](const Format& format) { return format.extension == wanted; });
    if (found == std::end(formats))
        throw Error("cannot write the mesh format \"" + wanted + "\"", path.string(),
                    "use .ply, .obj, .stl, .vtp, .glb or .gltf");
    return *found;
}

}  // namespace

void check_mesh_name(const std::filesystem::path& path) { format_of(path); }

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const VertexValues& values) {
    check(mesh, path.string());
    if (!values.values.empty() && values.values.size() != mesh.positions.size())
        throw Error(fmt::format("{} values for {} vertices", values.values.size(), mesh.positions.size()),
                    path.string(), "hand in one for each, or none");
    write_text(path, format_of(path).text(mesh, values, path.string()));
}

}  // namespace palpate
