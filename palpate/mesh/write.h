#pragma once
#include "palpate/mesh/mesh.h"

#include <filesystem>

namespace palpate {

/// Writes PLY (binary, little-endian) or OBJ, chosen by the name's ending; positions in metres, with normals
/// where the mesh has them. Reading the file again gives the same floats. Whole or not at all. Throws Error.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace palpate
