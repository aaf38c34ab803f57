#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate {

/// The contents of a glTF file of one surface, with a morph target for each picture. Its binary part holds,
/// in this order and without gaps: the triangles; positions, and normals if any; for each picture the
/// displacements of positions and normals; the pictures' times (s); and for each picture the weights of all
/// morph targets, 1 for its own and 0 for the others. So a player blends linearly between two neighbouring
/// pictures.
struct GltfContents {
    std::size_t vertices = 0, faces = 0;
    bool normals = false;
    Bounds box;                 // of the positions
    std::vector<Bounds> moves;  // of the displacements of positions, one for each picture
    std::vector<float> times;   // s, increasing, one for each picture

    /// The bytes of the first three parts; of one picture; of everything.
    std::uint64_t rest_bytes() const { return 12 * (faces + vertices * (normals ? 2u : 1u)); }
    std::uint64_t picture_bytes() const { return 12 * vertices * (normals ? 2u : 1u); }
    std::uint64_t bytes(std::uint64_t pictures) const {
        return rest_bytes() + pictures * (picture_bytes() + 4 + 4 * pictures);
    }
};

/// Few programs read more bytes, though the format allows twice as many.
constexpr std::uint64_t gltf_limit = (std::uint64_t(1) << 31) - 1;

/// The contents of a file without pictures, and its binary part. A zero normal becomes (0, 0, 1), because the
/// format requires unit normals. Throws Error (which names `file`) if the mesh has no triangles, or too many.
GltfContents gltf_contents(const Mesh& mesh, const std::string& file);
std::string gltf_binary(const Mesh& mesh);

/// A normal made unit, as glTF requires.
vec3 gltf_normal(vec3 normal);

/// The JSON that describes the binary part, which is at `uri`; empty for a GLB.
std::string gltf_json(const GltfContents& contents, const std::string& uri = "");

/// A GLB file up to its binary part.
std::string glb_head(const GltfContents& contents);

/// Whole files: binary, and text with the binary part inside.
std::string glb(const Mesh& mesh, const std::string& file);
std::string gltf(const Mesh& mesh, const std::string& file);

}  // namespace palpate
