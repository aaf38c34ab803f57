#pragma once
#include "palpate/mesh/mesh.h"

#include <filesystem>
#include <span>
#include <string_view>

namespace palpate {

/// A number for each vertex of a surface, such as a pressure; or none.
struct VertexValues {
    std::string_view name;  // a word
    std::span<const float> values;
};

/// Throws Error if write_mesh has no format for this file name.
void check_mesh_name(const std::filesystem::path& path);

/// Writes a surface in metres, with its normals if it has any, in the format of the file name's extension:
/// - `.ply`: binary, little-endian; reading it again gives the same floats and indices;
/// - `.obj`: text; what it keeps, read.h says;
/// - `.stl`: binary; each face with its own corners and its own normal, 0 if it is degenerate;
/// - `.vtp`: VTK's XML PolyData, its numbers appended as raw bytes;
/// - `.glb`, `.gltf`: glTF 2.0, in one file; normals are made unit.
///
/// Values of vertices are written to `.ply` and `.vtp`; the other formats have no place for them.
///
/// The file is written whole or not at all. Throws Error if it cannot be written, if there is not one value
/// for each vertex, or if its format cannot hold the mesh: glTF needs at least one triangle, and at most 2
/// GB.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const VertexValues& values = {});

}  // namespace palpate
