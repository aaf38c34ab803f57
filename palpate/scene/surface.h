#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// A surface, and what was done to get it, a line each with its counts.
struct CleanSurface {
    Mesh mesh;
    /// Of a recipe with maps: what is seen of it, the file's own surface, in the same place. It has several
    /// vertices where a texture has a seam, and may be open where the mesh is not. Else empty: that is the
    /// mesh.
    Mesh drawn;
    std::vector<std::string> steps;
    std::vector<std::string> notes;  // what was decided without being asked, or looks wrong
};

/// The surface of one recipe: read, mended, simplified, placed. It encloses a volume, but for a sheet's and a
/// cage's. Not for a plain box or a rectangle of cloth, whose surface comes from its nodes. Throws Error;
/// also if the recipe has maps and the file no texture coordinates.
CleanSurface make_surface(const BodyRecipe& recipe, const std::filesystem::path& folder,
                          const Progress& progress = {});

/// What looks wrong with a surface's size, or nothing: over 10 m or under 1 mm the unit is probably not what
/// was said.
std::string size_warning(const Mesh& surface);

}  // namespace palpate
