#include "palpate/files/formats/draco.h"

#include "palpate/base/isolated.h"
#include "palpate/files/formats/lists.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <memory>

namespace palpate {
namespace {

std::unique_ptr<draco::Mesh> decoded(const DracoPacked& packed, const Source& source) {
    draco::DecoderBuffer buffer;
    buffer.Init(packed.bytes.data(), packed.bytes.size());
    auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) source.broken("damaged Draco compression");
    return std::move(mesh).value();
}

std::vector<double> corners_of(const draco::Mesh& mesh) {
    std::vector<double> corners;
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (int k = 0; k < 3; ++k) corners.push_back(mesh.face(face)[std::size_t(k)].value());
    return corners;
}

// Raw numbers: the glTF says how to scale integers.
std::vector<double> numbers_of(draco::Mesh& mesh, std::uint32_t id, const Source& source) {
    const int place = mesh.GetAttributeIdByUniqueId(id);
    if (place < 0) source.broken(fmt::format("a Draco mesh without attribute {}", id));
    draco::PointAttribute& attribute = *mesh.attribute(place);
    attribute.set_normalized(false);
    const auto components = std::size_t(attribute.num_components());
    std::vector<double> numbers(components * mesh.num_points());
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point)
        attribute.ConvertValue<double>(attribute.mapped_index(point), std::int8_t(components),
                                       &numbers[components * point.value()]);
    return numbers;
}

}  // namespace

std::vector<DracoMesh> unpack_draco(const std::vector<DracoPacked>& packed, const Source& source,
                                    std::size_t most) {
    std::vector<DracoMesh> meshes;
    if (packed.empty()) return meshes;
    const Allowance allowance{.seconds = 15, .bytes = most, .output = most};
    const Written written = isolated("Draco's decoder", source.name(), allowance, [&](std::FILE* to) {
        for (const DracoPacked& one : packed) {
            const std::unique_ptr<draco::Mesh> mesh = decoded(one, source);
            put(to, corners_of(*mesh));
            for (std::uint32_t id : one.attributes) put(to, numbers_of(*mesh, id, source));
        }
    });
    std::span<const char> bytes = written.bytes();
    for (const DracoPacked& one : packed) {
        DracoMesh& mesh = meshes.emplace_back();
        mesh.attributes.resize(one.attributes.size());
        bool whole = take(bytes, mesh.corners);
        for (std::vector<double>& numbers : mesh.attributes) whole = whole && take(bytes, numbers);
        if (!whole) source.broken("damaged Draco compression");
    }
    return meshes;
}

}  // namespace palpate
