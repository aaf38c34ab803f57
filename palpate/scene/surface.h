#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/mesh.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// A repaired surface, and the steps that made it, one line each.
struct CleanSurface {
    Mesh mesh;
    /// For a recipe with maps: what is drawn, the file's original surface, in the same place. It has several
    /// vertices at texture seams, and may be open although the mesh is closed. Otherwise empty: the mesh is
    /// drawn.
    Mesh drawn;
    std::vector<std::string> steps;
    std::vector<std::string> notes;  // automatic decisions, and what looks wrong
};

/// Makes the surface of one recipe: reads, repairs, decimates and places it. It encloses a volume, except for
/// a sheet or a cage. Not for a plain box or a rectangle of cloth, whose surface comes from its nodes. Throws
/// Error, also if the recipe has maps but the file has no texture coordinates.
CleanSurface make_surface(const BodyRecipe& recipe, const std::filesystem::path& folder,
                          const Progress& progress = {});

/// A warning about a surface's size, or empty: above 10 m or below 1 mm its unit is probably wrong.
std::string size_warning(const Mesh& surface);

}  // namespace palpate
