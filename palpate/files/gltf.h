#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate {

/// What a glTF file holds of one surface. Its binary part has, in this order and without gaps: the triangles;
/// positions, and normals if there are any; for each picture how far positions and normals are from those;
/// the pictures' times (s); and for each picture the weights of all of them, 1 for its own and 0 for the
/// others. So between two pictures, and only between those, a player blends them evenly.
struct GltfContents {
    std::size_t vertices = 0, faces = 0;
    bool normals = false;
    Bounds box;                 // of the positions
    std::vector<Bounds> moves;  // of the positions' ways, one a picture
    std::vector<float> times;   // s, rising, one a picture

    /// Of the first three parts; of one picture; of all.
    std::uint64_t rest_bytes() const { return 12 * (faces + vertices * (normals ? 2u : 1u)); }
    std::uint64_t picture_bytes() const { return 12 * vertices * (normals ? 2u : 1u); }
    std::uint64_t bytes(std::uint64_t pictures) const {
        return rest_bytes() + pictures * (picture_bytes() + 4 + 4 * pictures);
    }
};

/// More than so many bytes few programs read, though the format ends at twice that.
constexpr std::uint64_t gltf_limit = (std::uint64_t(1) << 31) - 1;

/// The contents of a file without pictures, and its binary part. A normal of no length becomes (0, 0, 1),
/// because the format has only unit ones. Throws Error (which names `file`) if the mesh has no triangles, or
/// too many.
GltfContents gltf_contents(const Mesh& mesh, const std::string& file);
std::string gltf_binary(const Mesh& mesh);

/// A normal as glTF allows it: unit.
vec3 gltf_normal(vec3 normal);

/// The JSON that describes the binary part, which is found at `uri`; in a GLB there is none.
std::string gltf_json(const GltfContents& contents, const std::string& uri = "");

/// All of a GLB file but its binary part, which follows.
std::string glb_head(const GltfContents& contents);

/// Whole files: binary, and text with the binary part inside.
std::string glb(const Mesh& mesh, const std::string& file);
std::string gltf(const Mesh& mesh, const std::string& file);

}  // namespace palpate
