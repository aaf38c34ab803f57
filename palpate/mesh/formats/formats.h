#pragma once
#include "palpate/mesh/formats/draft.h"
#include "palpate/mesh/formats/source.h"

#include <filesystem>

namespace palpate {

// One reader a format. Each throws Error if the file is truncated or damaged, and allocates for what is
// there only, never for what the file claims.

Draft read_obj(Source source);
Draft read_off(Source source);
Draft read_ply(Source source);
Draft read_stl(Source source);
Draft read_vrml(Source source);

/// Whether assimp has a reader for files of this ending (".fbx").
bool assimp_knows(const std::string& ending);

/// Reads the file in a process of its own, by the ending of its name. `folder`: where other files that it
/// names may lie; empty: nowhere.
Draft read_with_assimp(const Source& source, const std::filesystem::path& folder);

}  // namespace palpate
