#pragma once
#include "palpate/files/formats/draft.h"
#include "palpate/files/formats/source.h"

namespace palpate {

// One reader for each format. Each throws Error if the file is truncated or damaged, and allocates only for
// what is there, never for what the file claims.

Draft read_3mf(Source source);
Draft read_gltf(Source source);  // and GLB
Draft read_obj(Source source);
Draft read_off(Source source);
Draft read_ply(Source source);
Draft read_stl(Source source);
Draft read_vrml(Source source);        // VRML 2, and X3D in VRML's syntax
Draft read_vrml_nodes(Source source);  // the same without its header
Draft read_x3d(Source source);         // X3D as XML

/// Whether assimp has a reader for files with this extension (".fbx").
bool assimp_knows(const std::string& extension);

/// Reads the file in a process of its own, by its extension.
Draft read_with_assimp(const Source& source);

}  // namespace palpate
