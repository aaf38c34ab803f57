#pragma once
#include "palpate/mesh/mesh.h"

#include <filesystem>

namespace palpate {

/// Throws Error if write_mesh knows no format for a file of this name.
void check_mesh_name(const std::filesystem::path& path);

/// Writes a surface in metres, with normals where it has them, in the format of the name's ending:
/// - `.ply`: binary, little-endian; reading it again gives the same floats and indices;
/// - `.obj`: text; what it keeps, read.h says;
/// - `.stl`: binary; each face with corners of its own and its own normal, 0 where it has no area;
/// - `.vtp`: VTK's XML PolyData, its numbers appended as raw bytes;
/// - `.glb`, `.gltf`: glTF 2.0, in one file; normals are made unit.
///
/// Whole or not at all. Throws Error if the file cannot be written, or its format cannot hold the mesh: glTF
/// wants triangles, and at most 2 GB.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace palpate
