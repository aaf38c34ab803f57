#pragma once
#include "palpate/mesh/mesh.h"

#include <filesystem>

namespace palpate {

/// Throws Error if write_mesh knows no format for a file of this name.
void check_mesh_name(const std::filesystem::path& path);

/// Writes PLY (binary, little-endian) or OBJ, chosen by the name's ending; positions in metres, with normals
/// where the mesh has them. Reading a PLY again gives the same floats and indices; what an OBJ keeps, read.h
/// says. Whole or not at all. Throws Error.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace palpate
